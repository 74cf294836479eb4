#!/usr/bin/env python3
"""Triangles per CPU second on one rank, beside `gmsh -2` with its default algorithm, at equal sizes.

usage: surface_rate.py SURFACE_BENCHMARK [CASE ...] [--page FILE]

Cases are names of the table below; all of them where none is given. Gmsh is asked for the same bounds and the
same angle per element; its time is that of its 1-D and 2-D meshing, without reading the file. Ours is that of
the surface stage, curves and the search for intersections included, and with the size field as well.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from far_fields import FAR_BOX
from printed_table import PrintedTable, take_page_option

ROOT = pathlib.Path(__file__).resolve().parent.parent
GEOMETRY = ROOT.parent / "shared" / "geometry"
CASES = {
    "sphere": dict(file=ROOT / "configs/geometry/sphere.brep", minimum=0.00539, maximum=0.00539, angle=30),
    "dlr_f6": dict(file=GEOMETRY / "aircraft/gmsh_dlr_f6.brep", minimum=1.5, maximum=12, angle=12, patches=FAR_BOX),
}


def ours(program, case, folder):
    config = folder / "case.yaml"
    config.write_text(
        f"geometry: {{file: {case['file']}, domain: fluid}}\n"
        f"sizing: {{minimum: {case['minimum']}, maximum: {case['maximum']}, curvature_angle: {case['angle']}}}\n"
        f"surface: {{piece_triangles: 3000}}\npatches: {json.dumps(case.get('patches', {}))}\n")
    text = subprocess.run([program, config], capture_output=True, text=True, check=True).stdout
    values = dict(re.findall(r"(\w+)=(\S+)", text))
    triangles = float(values["triangles"])
    return triangles, triangles / float(values["cpu_total"]), triangles / (
        float(values["cpu_total"]) + float(values["sizing_cpu"])), values


def gmsh(case, folder):
    mesh = folder / "mesh.msh"
    command = ["gmsh", "-2", "-nt", "1", "-clmin", str(case["minimum"]), "-clmax", str(case["maximum"]),
               "-setnumber", "Mesh.MeshSizeFromCurvature", str(360 / case["angle"]),
               "-setnumber", "Mesh.MeshSizeExtendFromBoundary", "1", "-format", "msh2", "-bin",
               "-o", mesh, case["file"]]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    cpu = sum(float(seconds) for seconds in re.findall(r"Done meshing [12]D \(Wall [\d.e+-]+s, CPU ([\d.e+-]+)s\)", text))
    triangles = count_triangles(mesh)
    return triangles, triangles / cpu


def count_triangles(mesh):
    """Elements of type 2 in a binary MSH 2 file."""
    data = mesh.read_bytes()
    at = data.index(b"$Elements\n") + len(b"$Elements\n")
    end = data.index(b"\n", at)
    left, at = int(data[at:end]), end + 1
    nodes = {1: 2, 2: 3, 15: 1, 3: 4}
    triangles = 0
    while left > 0:
        kind, count, tags = (int.from_bytes(data[at + 4 * i:at + 4 * i + 4], "little") for i in range(3))
        at += 12 + count * 4 * (1 + tags + nodes[kind])
        left -= count
        triangles += count if kind == 2 else 0
    return triangles


def main():
    arguments, page = take_page_option(sys.argv[1:])
    program, names = arguments[0], arguments[1:] or list(CASES)
    table = PrintedTable("Triangles per CPU second", (
        "case", "triangles", "Gmsh", "per CPU s", "with the size field", "Gmsh per CPU s", "ratio", "with the size field"))
    for name in names:
        case = CASES[name]
        if not case["file"].exists():
            print(f"{name}: {case['file']} is not here", file=sys.stderr)
            continue
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            triangles, rate, rate_with_sizes, _ = ours(program, case, folder)
            theirs, their_rate = gmsh(case, folder)
        table.add(name, f"{triangles:,.0f}", f"{theirs:,}", f"{rate:,.0f}", f"{rate_with_sizes:,.0f}", f"{their_rate:,.0f}",
                  f"{rate / their_rate:.2f}", f"{rate_with_sizes / their_rate:.2f}")
    table.save(page)


if __name__ == "__main__":
    main()
