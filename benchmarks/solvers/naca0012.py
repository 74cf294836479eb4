#!/usr/bin/env python3
"""Turbulent flow about NACA 0012 at a Reynolds number of 6 million by OpenFOAM's simpleFoam with k-omega SST, on a mesh with boundary
layers and on a C-grid of blockMesh, with the same domain, first height and turbulence of the free stream.

usage: naca0012.py FOLDER [--angle 10] [--steps 1500] [--y-plus 1] [--ranks 1] [--program AEROLOOM] [--report] [--page FILE]

Both start from uniform flow. Our case runs as the program writes it: what is set is its number of iterations, the direction of the flow and
the area of reference. The C-grid, which is one process, has schemes and relaxation of its own (simple_case.py). Called again, runs go on
from their last written step. Needs OpenFOAM v1912 or later and Gmsh, which makes the CAD. Ends with a line RESULT; the exit code says
whether lift lies within 3 % and drag within 6 % of the C-grid's (drag alone without incidence) and both were steady to 0.5 % over the last
300 steps.
"""
import argparse
import pathlib
import sys

import naca0012_grids as grids
import simple_case
import written_case
from potential_flow import ROOT, run

sys.path.append(str(ROOT / "benchmarks"))
from printed_table import PrintedTable, add_page_option  # noqa: E402

LAST = 300
STEADY, LIFT_SHARE, DRAG_SHARE = 0.005, 0.03, 0.06
# NASA's page on turbulence models, finest grids, far field at 500 chords: lift, drag by angle.
NASA = {0.0: (0.0, 0.0081), 10.0: (1.09, 0.0123)}


def solve_layers(folder, options):
    """Meshes where no case is yet, and runs it as written."""
    written = folder / "openfoam"
    if not (written / "run.sh").exists():
        folder.mkdir(parents=True, exist_ok=True)
        grids.write_geometry(folder)
        case = grids.write_case(folder, options.angle, options.y_plus)
        run([options.program, "run", case, "--set", f"output.directory={folder}", "--set", f"output.parts={options.ranks}"], folder,
            "log.aeroloom")
    written_case.set_conditions(written, reference_area=grids.SPAN)
    written_case.turn_flow(written, options.angle)
    written_case.set_iterations(written, options.steps)
    if written_case.run(written):
        sys.exit(f"{written}: run.sh failed; see log.simpleFoam there")


def solve_c_grid(folder, options):
    """From the last step written, else from uniform flow, to the last step wanted."""
    simple_case.write_case(folder, options.angle, grids.REYNOLDS)
    if not (folder / "constant/polyMesh/owner").exists():
        simple_case.write_control(folder, options.angle, options.steps, grids.SPAN)
        simple_case.write_file(folder / "system/blockMeshDict", "dictionary", grids.c_grid(options.y_plus))
        run(["blockMesh"], folder, "log.blockMesh")
        run(["checkMesh"], folder, "log.checkMesh")
    for steps in (min(simple_case.CAREFUL_STEPS, options.steps), options.steps):
        simple_case.write_control(folder, options.angle, steps, grids.SPAN)
        run(["simpleFoam"], folder, f"log.simpleFoam.{steps}")


def figures(folder):
    """Of the last LAST steps: mean lift and drag with their spreads over the mean (lift's over drag where there is no lift), y+."""
    forces = written_case.coefficients(folder)
    found = [words for words in written_case.tables(folder, "wall_distance", "yPlus.dat") if words[0] != "#"]
    if not forces or not found:
        sys.exit(f"{folder}: no step was written; see log.simpleFoam* there, or wait for the first {simple_case.CAREFUL_STEPS} steps")
    drag, lift = forces["Cd"][-LAST:], forces["Cl"][-LAST:]
    mean = {"drag": sum(drag) / len(drag), "lift": sum(lift) / len(lift)}
    size = max(abs(mean["lift"]), abs(mean["drag"]))
    low, high, average = (float(word) for word in found[-1][2:5])
    cells = next(int(line.split()[-1]) for line in (folder / "log.checkMesh").read_text().splitlines() if "cells:" in line)
    return {"step": int(forces["Time"][-1]), "lift": mean["lift"], "drag": mean["drag"], "lift_spread": (max(lift) - min(lift)) / size,
            "drag_spread": (max(drag) - min(drag)) / abs(mean["drag"]), "y_least": low, "y_most": high, "y_mean": average,
            "cells": cells, "steps_seen": len(drag)}


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
    parser.add_argument("--steps", type=int, default=1500, help="a multiple of 100, after which steps are written")
    parser.add_argument("--y-plus", type=float, default=1.0, help="of the first cell's centre")
    parser.add_argument("--ranks", type=int, default=1, help="for our mesh")
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
        solve_c_grid(c_grid, options)
        solve_layers(layers, options)
    sys.exit(0 if report({"layers": figures(layers / "openfoam"), "c_grid": figures(c_grid)}, options) else 1)


if __name__ == "__main__":
    main()
