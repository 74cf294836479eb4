#!/usr/bin/env python3
"""Flow about what is in a mesh by OpenFOAM, with nothing but what was written beside the mesh: simpleFoam with the k-omega SST model.

usage: turbulent_flow.py MESH FOLDER [--ranks N] [--steps N] [--program AEROLOOM]

FOLDER gets the case. Ends with a table of residuals and a line RESULT; the exit code says whether all steps were made and the
residuals of velocity fell.
"""
import argparse
import pathlib
import re
import sys
import time

from potential_flow import ROOT, run

FIELDS = ("Ux", "Uy", "Uz", "p", "k", "omega")


def residuals_of(log):
    """By field, the first initial residual of each step."""
    steps = log.split("\nTime = ")[1:]
    found = {}
    for field in FIELDS:
        found[field] = [float(match.group(1)) for match in (re.search(
            rf"Solving for {field}, Initial residual = (\S+),", step) for step in steps) if match]
    return len(steps), found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--program", default=ROOT / "build/release/bin/aeroloom")
    options = parser.parse_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True)
    ranks = [ROOT / "scripts/mpirun_local.sh", options.ranks]
    parallel = ["-parallel"] if options.ranks > 1 else []
    run([*ranks, options.program, "convert", options.mesh.resolve(), folder / "mesh.foam", "--parts",
         options.ranks], folder, "log.convert")
    checked = run([*ranks, "checkMesh", "-allGeometry", "-allTopology", *parallel], folder, "log.checkMesh")
    began = time.monotonic()
    control = folder / "system" / "controlDict"
    control.write_text(re.sub(r"(endTime +)\d+;", rf"\g<1>{options.steps};", control.read_text()))
    log = run([*ranks, "simpleFoam", *parallel], folder, "log.simpleFoam")
    seconds = time.monotonic() - began
    steps, residuals = residuals_of(log)
    shown = [step for step in (1, 2, 5, 10, 20, 50, 100, 150, 200, 300, 500, 1000) if step <= steps]
    print("| step | " + " | ".join(FIELDS) + " |\n|---|" + "---|" * len(FIELDS))
    for step in shown:
        print(f"| {step} | " + " | ".join(f"{residuals[f][step - 1]:.1e}" for f in FIELDS) + " |")
    pressure = [int(n) for n in re.findall(r"GAMG:  Solving for p, .* No Iterations (\d+)", log)]
    largest = max(residuals["Ux"][-1], residuals["Uy"][-1], residuals["Uz"][-1])
    cells = re.search(r"cells: +(\d+)", checked).group(1)
    continuity = re.findall(r"sum local = ([^,]+),", log)[-1]
    print(f"RESULT cells={cells} ranks={options.ranks} steps={steps} seconds={seconds:.0f} velocity_residual={largest:.2e} "
          f"pressure_residual={residuals['p'][-1]:.2e} most_pressure_iterations={max(pressure)} "
          f"bounded={len(re.findall('bounding ', log))} warnings={log.count('Warning')} continuity={continuity}")
    sys.exit(0 if steps == options.steps and largest < 0.1 * max(residuals["Ux"][:3]) else 1)


if __name__ == "__main__":
    main()
