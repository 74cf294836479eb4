#!/usr/bin/env python3
"""Turbulent flow about NACA 0012 at a Reynolds number of 6 million by OpenFOAM's simpleFoam with k-omega SST, on a mesh with boundary
layers and on a C-grid of blockMesh, with the same domain, schemes and wall functions.

usage: naca0012.py FOLDER [--angle 10] [--steps 3000] [--y-plus 30] [--program AEROLOOM] [--report]
                   [--page FILE]

The run on the C-grid starts from a uniform flow, that on the other mesh, whose steps are dearer, from the C-grid's flow; each is one
process. Called again, they go on from their last written step. Needs OpenFOAM v1912 or later, Gmsh, which makes the CAD, and Python's
scipy. Ends with a line RESULT; the exit code says whether lift lies within 3 % and drag within 10 % of the C-grid's (drag alone without
incidence) and both were steady to 0.5 % over the last 300 steps.
"""
import argparse
import pathlib
import sys

import naca0012_grids as grids
import simple_case
import start_from
from potential_flow import ROOT, run

sys.path.append(str(ROOT / "benchmarks"))
from printed_table import PrintedTable, add_page_option  # noqa: E402

LAST = 300
STEADY, LIFT_SHARE, DRAG_SHARE = 0.005, 0.03, 0.10
# NASA's page on turbulence models, finest grids, far field at 500 chords: lift, drag by angle.
NASA = {0.0: (0.0, 0.0081), 10.0: (1.09, 0.0123)}


def make_layers(folder, options):
    """The mesh of Aeroloom, renumbered for the solver."""
    root = folder.parent
    grids.write_geometry(root)
    case = grids.write_case(root, options.angle, options.y_plus)
    run([options.program, "run", case, "--set", f"output.directory={root / 'mesh'}"], folder, "log.aeroloom")
    run([options.program, "convert", root / "mesh/mesh.pvtu", folder / "mesh.foam", "--parts", 1], folder, "log.convert")
    # Fields that came with the mesh are not this case's.
    (folder / "0/Phi").unlink(missing_ok=True)
    run(["renumberMesh", "-overwrite"], folder, "log.renumberMesh")


def make_c_grid(folder, options):
    simple_case.write_file(folder / "system/blockMeshDict", "dictionary", grids.c_grid(options.y_plus))
    run(["blockMesh"], folder, "log.blockMesh")


def solve(folder, make, options, start=None):
    """From the last step written, else from the flow in the case `start`, else from a uniform flow, to the last step wanted."""
    folder.mkdir(parents=True, exist_ok=True)
    simple_case.write_case(folder, options.angle, grids.REYNOLDS)
    simple_case.write_control(folder, options.angle, options.steps, grids.SPAN)
    if not (folder / "constant/polyMesh/owner").exists():
        make(folder, options)
    run(["checkMesh"], folder, "log.checkMesh")
    careful = [min(simple_case.CAREFUL_STEPS, options.steps)]
    if start and not any(path.name.isdigit() and path.name != "0" for path in folder.iterdir()):
        simple_case.write_case(folder, options.angle, grids.REYNOLDS)  # renumberMesh left its fields in binary
        start_from.start_from(folder, start)
        careful = []
    for steps in (*careful, options.steps):
        simple_case.write_control(folder, options.angle, steps, grids.SPAN)
        run(["simpleFoam"], folder, f"log.simpleFoam.{steps}")


def rows_of(folder, name, file):
    """By step, the columns of what a function object wrote in all starts; later starts win. A start from a step that had one
    before gives its file another name."""
    rows = {}
    stem, ending = file.split(".")
    for path in sorted((folder / "postProcessing" / name).glob(f"*/{stem}*.{ending}"), key=lambda p: p.stat().st_mtime_ns):
        for line in path.read_text().splitlines():
            words = line.split()
            if words and not words[0].startswith("#"):
                rows[int(float(words[0]))] = words[1:]
    return rows


def figures(folder):
    """Of the last LAST steps: mean lift and drag with their spreads over the mean (lift's over drag where there is no lift), y+."""
    rows = rows_of(folder, "forces", "coefficient.dat")
    found = rows_of(folder, "wall_distance", "yPlus.dat")
    if not rows or not found:
        sys.exit(f"{folder}: no step was written; see log.simpleFoam.* there, or wait for the first {simple_case.CAREFUL_STEPS} steps")
    steps = sorted(rows)[-LAST:]
    drag, lift = [[float(rows[s][column]) for s in steps] for column in (0, 2)]
    mean = {"drag": sum(drag) / len(drag), "lift": sum(lift) / len(lift)}
    size = max(abs(mean["lift"]), abs(mean["drag"]))
    low, high, average = (float(word) for word in found[max(found)][1:4])
    cells = next(int(line.split()[-1]) for line in (folder / "log.checkMesh").read_text().splitlines() if "cells:" in line)
    return {"step": steps[-1], "lift": mean["lift"], "drag": mean["drag"], "lift_spread": (max(lift) - min(lift)) / size,
            "drag_spread": (max(drag) - min(drag)) / abs(mean["drag"]), "y_least": low, "y_most": high, "y_mean": average,
            "cells": cells, "steps_seen": len(steps)}


def report(found, options):
    """The table and the line RESULT; whether all held."""
    table = PrintedTable(f"{options.angle:g} degrees", ("grid", "cells", "step", "lift", "its spread", "drag", "its spread", "y+ mean", "least",
                                                        "most"))
    for name, row in found.items():
        table.add(name, f"{row['cells']:,}", row["step"], f"{row['lift']:.4f}", f"{100 * row['lift_spread']:.2f} %", f"{row['drag']:.5f}",
                  f"{100 * row['drag_spread']:.2f} %", f"{row['y_mean']:.1f}", f"{row['y_least']:.1f}", f"{row['y_most']:.1f}")
    if options.angle in NASA:
        lift, drag = NASA[options.angle]
        table.add("NASA", "", "", lift, "", drag)
    table.save(options.page)
    ours, theirs = found["layers"], found["c_grid"]
    with_lift = abs(theirs["lift"]) > 0.1
    lift_off = ours["lift"] / theirs["lift"] - 1 if with_lift else ours["lift"] - theirs["lift"]
    drag_off = ours["drag"] / theirs["drag"] - 1
    steady = all(row["steps_seen"] == LAST and max(row["lift_spread"], row["drag_spread"]) <= STEADY for row in found.values())
    good = steady and abs(drag_off) <= DRAG_SHARE and abs(lift_off) <= LIFT_SHARE
    print(f"RESULT angle={options.angle:g} y_plus={options.y_plus:g} y_plus_found={ours['y_mean']:.1f} lift={ours['lift']:.4f} "
          f"drag={ours['drag']:.5f} lift_off={lift_off:+.4f} drag_off={drag_off:+.4f} steady={int(steady)} ok={int(good)}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--angle", type=float, default=10.0, help="of incidence, in degrees")
    parser.add_argument("--steps", type=int, default=3000, help="a multiple of 100, after which steps are written")
    parser.add_argument("--y-plus", type=float, default=30.0, help="of the first cell's centre")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--report", action="store_true", help="only read what runs have written so far")
    add_page_option(parser)
    options = parser.parse_args()
    if options.steps < 100 or options.steps % 100:
        parser.error(f"--steps {options.steps} is no multiple of 100")
    options.program = options.program.resolve()
    folder = options.folder.resolve()
    c_grid, layers = folder / "c_grid", folder / "layers"
    if not options.report:
        solve(c_grid, make_c_grid, options)
        solve(layers, make_layers, options, start=c_grid)
    sys.exit(0 if report({"layers": figures(layers), "c_grid": figures(c_grid)}, options) else 1)


if __name__ == "__main__":
    main()
