#!/usr/bin/env python3
"""Whole runs from CAD to mesh beside Gmsh with HXT on the same CAD, as Markdown tables.

usage: whole_run.py PROGRAM CASE ... [--arbiter CHECKER] [--ranks N ...] [--repeat N] [--page FILE] [-- KEY=VALUE ...]

For each case: our program on so many ranks (default 1 and 2), and Gmsh on one thread with the domain that our program
exports as STEP, sizes from curvature with the angle and the bounds of our sizes, scaled until the numbers of
tetrahedra are within 20 % of each other. Wall seconds are those of the processes from start to end, with reading and
writing; the least of N (default 2) repeats taken in turn. CHECKER is an independent checker of meshes, called as
`CHECKER mesh.pvtu --surface surface.pvtp`. The second table has the stages of both.

Needs gmsh.
"""
import argparse
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

from printed_table import PrintedTable, add_page_option

LIMIT_S = 180
ROOT = pathlib.Path(__file__).resolve().parent.parent


def call(command, folder):
    start = time.monotonic()
    done = subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return time.monotonic() - start, done.stdout


def ours(options, case, ranks, folder):
    command = [ROOT / "scripts/mpirun_local.sh", ranks, options.program, "run", os.path.abspath(case)]
    for setting in [f"output.directory={folder}", "output.pictures=false", *options.settings]:
        command += ["--set", setting]
    wall, _ = call(command, ROOT)
    report = json.loads((folder / "report.json").read_text())
    return wall, report


def verdict(options, folder):
    if not options.arbiter:
        return "–"
    said = subprocess.run([options.arbiter, folder / "mesh.pvtu", "--surface", folder / "surface.pvtp"],
                          capture_output=True, text=True, check=False).stdout
    return "yes" if "VALID yes" in said else "NO"


def theirs(folder, sizes, factor):
    """Wall seconds, tetrahedra, and seconds of 1-D, 2-D, 3-D; None where Gmsh fails or takes more than LIMIT_S."""
    curvature = 360 / sizes["curvature_angle"]
    (folder / "domain.geo").write_text(
        'SetFactory("OpenCASCADE");\nMerge "domain.step";\n'
        f"Mesh.MeshSizeFromCurvature = {curvature:.6g};\n"
        f"Mesh.MeshSizeMin = {sizes['minimum']:.9g};\nMesh.MeshSizeMax = {sizes['maximum']:.9g};\n"
        f"Mesh.MeshSizeFactor = {factor:.9g};\n")
    command = ["timeout", LIMIT_S, "gmsh", "domain.geo", "-3", "-algo", "hxt", "-nt", "1", "-format", "msh41", "-bin", "-o",
               "theirs.msh"]
    try:
        wall, said = call(command, folder)
    except RuntimeError:
        return None
    steps = [float(t) for t in re.findall(r"Done meshing [123]D \(Wall ([\d.e+-]+)s", said)]
    with open(folder / "theirs.msh", "rb") as file:
        tetrahedra = count_tetrahedra(file.read())
    return {"wall": wall, "tetrahedra": tetrahedra, "steps": steps}


def count_tetrahedra(data):
    """Of a binary MSH 4.1 file: blocks of elements of one type, each under its entity."""
    at = data.index(b"$Elements\n") + len(b"$Elements\n")
    blocks, _, _, _ = struct.unpack_from("<4Q", data, at)
    at, found = at + 32, 0
    corners = {15: 1, 1: 2, 2: 3, 4: 4}
    for _ in range(blocks):
        _, _, kind, count = struct.unpack_from("<3iQ", data, at)
        found += count if kind == 4 else 0
        at += 20 + count * 8 * (1 + corners[kind])
    return found


def matched(folder, sizes, wanted):
    """The factor for their sizes at which the counts agree within 20 %."""
    factor, tried = 1.0, []
    for _ in range(8):
        found = theirs(folder, sizes, factor)
        if found is None:
            return None
        error = found["tetrahedra"] / wanted
        tried.append((abs(error - 1), factor))
        if 0.85 < error < 1.18:
            break
        factor *= min(max(error, 0.1), 10) ** 0.4
    return min(tried)[1]


def run_case(options, case):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        runs, gmsh, factor = {}, None, 0
        call([options.program, "export-cad", os.path.abspath(case), folder / "domain.step", "--domain"], ROOT)
        for _ in range(options.repeat):
            for ranks in options.ranks:
                wall, report = ours(options, case, ranks, folder / f"ours{ranks}")
                if ranks not in runs or wall < runs[ranks][0]:
                    runs[ranks] = (wall, report)
            first = runs[options.ranks[0]][1]
            if factor == 0:
                factor = matched(folder, first["sizing"], first["mesh"]["tetrahedra"])
            found = theirs(folder, first["sizing"], factor) if factor else None
            if found and (gmsh is None or found["wall"] < gmsh["wall"]):
                gmsh = found
        valid = {ranks: verdict(options, folder / f"ours{ranks}") for ranks in options.ranks}
    return runs, gmsh, valid


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--arbiter")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=2)
    add_page_option(parser)
    options = parser.parse_args(arguments, argparse.Namespace(settings=settings))
    stages = []
    table = PrintedTable("Whole runs beside Gmsh", ("case", "mesher", "ranks", "tetrahedra", "wall s", "µs per tetrahedron", "over Gmsh",
                                                    "over one rank", "least angle", "valid"))
    for case in options.cases:
        runs, gmsh, valid = run_case(options, case)
        label = pathlib.Path(case).stem
        theirs_each = gmsh["wall"] / gmsh["tetrahedra"] if gmsh else None
        alone = runs[options.ranks[0]][0]
        for ranks, (wall, report) in runs.items():
            count = report["mesh"]["tetrahedra"]
            table.add(label, "Aeroloom", ranks, f"{count:,}", f"{wall:.1f}", f"{1e6 * wall / count:.1f}",
                      f"{wall / count / theirs_each:.2f}" if gmsh else "–", f"{wall / alone:.2f}",
                      f"{report['quality']['min_dihedral_deg']:.1f}", valid[ranks])
            stages.append((label, f"Aeroloom, {ranks}", ", ".join(
                f"{s['name']} {s['wall_seconds']:.2f} ({s['cpu_seconds_max']:.2f})" for s in report["stages"])))
        if not gmsh:
            table.add(label, "Gmsh HXT", 1, f"none, or not within {LIMIT_S} s", *"––––––")
            continue
        table.add(label, "Gmsh HXT", 1, f"{gmsh['tetrahedra']:,}", f"{gmsh['wall']:.1f}", f"{1e6 * theirs_each:.1f}", 1, "–", "–", "–")
        stages.append((label, "Gmsh HXT", ", ".join(f"{k + 1}-D {t:.2f}" for k, t in enumerate(gmsh["steps"]))))
    table.save(options.page)
    print()
    table = PrintedTable("Stages of whole runs", ("case", "mesher, ranks", "stages, wall s (CPU s of the busiest rank)"))
    for row in stages:
        table.add(*row)
    table.save(options.page)


if __name__ == "__main__":
    main()
