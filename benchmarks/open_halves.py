#!/usr/bin/env python3
"""Meshes halves of bodies that are open on their plane of symmetry, made by open_halves, and prints a table in Markdown.

usage: open_halves.py [--build BUILD] [--target T] [--arbiter CHECKER] [--layer-arbiter CHECKER] [--only NAME ...] [--keep FOLDER]
                      [--page FILE] [FILE ...]

Each half must end in a valid mesh whose patch 'symmetry' has one coordinate in every bit, with walls whose area in the CAD, once it
is closed, is within 0.1 % of that of the body. Two are meshed with boundary layers too. FILE: other open halves, of which no area is
known; their case is FILE with the suffix .yaml, where there is one.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from printed_table import PrintedTable, add_page_option

LIMIT_S = 120
AREA = 1e-3  # of the body's walls
HALVES = ["fin_on_plane.brep", "nacelle.step", "wing_root.igs", "kinked_wing.step", "jagged.brep", "offset_small.step",
          "offset_large.step", "uneven.igs", "two_solids.brep", "blunt_base.step", "overlapping.igs", "open_tip.brep", "hatch.step"]
WITH_LAYERS = ["nacelle.step", "wing_root.igs", "fin_on_plane.brep"]
LAYERS = {"first": 0.5, "growth": 1.3, "count": 5}

Row = collections.namedtuple("Row", "file code tetrahedra angle plane cad_area mesh_area full closed valid seconds message good")


def planarity(surface):
    """The number of coordinates across the plane that the points of 'symmetry' have: one where it is exactly planar."""
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(str(surface))
    reader.Update()
    data = reader.GetOutput()
    names = data.GetFieldData().GetAbstractArray("patch_names")
    number = next(i for i in range(names.GetNumberOfValues()) if names.GetValue(i) == "symmetry")
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    sides = np.diff(vtk_to_numpy(data.GetPolys().GetOffsetsArray()))
    is_on_plane = np.repeat(vtk_to_numpy(data.GetCellData().GetArray("patch")) == number, sides)
    points = vtk_to_numpy(data.GetPoints().GetData())[corners[is_on_plane]].astype(np.float64)
    return min(len(np.unique(np.ascontiguousarray(points[:, axis]).view(np.uint64))) for axis in range(3))


def case_of(file, options, layers, output):
    beside = file.with_suffix(".yaml")
    text = beside.read_text().replace(file.name, str(file)) if beside.exists() else \
        f'geometry: {{file: "{file}"}}\nfarfield: {{shape: hemisphere, extent: 10, symmetry: y}}\n'
    if "sizing" not in text:
        text += f"sizing: {{target_tetrahedra: {options.target}}}\n"
    if layers:
        text += f"layers: {json.dumps(LAYERS)}\n"
    return text + f'output: {{directory: "{output}", pictures: false}}\n'


def launch(options, case):
    start = time.monotonic()
    try:
        done = subprocess.run([options.build / "bin" / "aeroloom", "run", case], capture_output=True, text=True, errors="replace",
                              timeout=LIMIT_S, check=False)
        return done.returncode, done.stdout + done.stderr, time.monotonic() - start
    except subprocess.TimeoutExpired:
        return -1, f"error: more than {LIMIT_S} s", time.monotonic() - start


def judge(options, output, layers):
    """What an independent arbiter says; True where there is none."""
    arbiter = options.layer_arbiter if layers else options.arbiter
    if not arbiter:
        return True
    done = subprocess.run([arbiter, output / "mesh.pvtu", "--surface", output / "surface.pvtp"], capture_output=True, text=True,
                          check=False)
    return "VALID yes" in done.stdout


def one(options, file, area, layers, folder):
    output, case = folder / f"{file.stem}{'_layers' if layers else ''}", folder / f"{file.stem}.case.yaml"
    case.write_text(case_of(file, options, layers, output))
    code, log, seconds = launch(options, case)
    name = f"{file.name}{', layers' if layers else ''}"
    if code != 0:
        errors = [line for line in log.splitlines() if line.startswith("error")]
        message = errors[0].removeprefix("error: ") if errors else "no message"
        return Row(name, code, None, None, "", None, None, None, "", False, seconds, message, False)
    report = json.loads((output / "report.json").read_text())
    walls = [patch for patch in report["patches"] if patch["type"] == "wall"]
    cad, mesh = (sum(patch[key] for patch in walls) for key in ("cad_area", "area"))
    closed = sum("closed" in change["what"] for change in report["geometry"]["changes"])
    exact = planarity(output / "surface.pvtp") == 1
    valid = judge(options, output, layers)
    deviation = None if area is None else cad / area - 1
    full = report["layers"]["full"] if layers else None
    good = valid and exact and (area is None or abs(deviation) <= AREA)
    return Row(name, code, report["mesh"]["tetrahedra"], report["quality"]["min_dihedral_deg"], "exact" if exact else "UNEVEN", deviation,
               mesh / cad - 1, full, closed, valid, seconds, "", good)


def make(options, name, folder):
    """The file and the area of the walls."""
    file = folder / name
    done = subprocess.run([options.build / "benchmarks" / "open_halves", file.stem, file], capture_output=True, text=True,
                          timeout=LIMIT_S, check=True)
    return file, float(done.stdout.split()[-1])


def percent(share, signed=True):
    return "" if share is None else f"{100 * share:+.3f}" if signed else f"{100 * share:.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "build/release")
    parser.add_argument("--target", type=int, default=60000)
    parser.add_argument("--arbiter", help="an independent checker of meshes")
    parser.add_argument("--layer-arbiter", help="one of meshes with boundary layers")
    parser.add_argument("--only", nargs="*", help="names of files")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for files and outputs")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Halves", ("file", "exit", "tetrahedra", "smallest dihedral", "plane of symmetry", "area of the CAD, % off",
                                    "area of the triangles, % off the CAD", "full layers, %", "closed", "valid", "s", "message"))
    bad = count = 0
    with tempfile.TemporaryDirectory(prefix="open_halves_") as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        names = [name for name in HALVES if not options.only or name in options.only]
        work = [(*make(options, name, folder), layers) for name in names for layers in (False, True) if not layers or name in WITH_LAYERS]
        work += [(file.resolve(), None, False) for file in options.files]
        for file, area, layers in work:
            row = one(options, file, area, layers, folder)
            count, bad = count + 1, bad + (not row.good)
            angle = "" if row.angle is None else f"{row.angle:.1f}"
            table.add(row.file, row.code, row.tetrahedra or "", angle, row.plane, percent(row.cad_area), percent(row.mesh_area),
                      percent(row.full, False), row.closed, "yes" if row.valid else "no", f"{row.seconds:.0f}",
                      f"{'' if row.good else '**not as wanted** '}{row.message}".replace(f"{folder}/", ""))
    note = f"{count} runs, {bad} not as wanted"
    print(f"\n{note}")
    table.save(options.page, f"{note}.")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
