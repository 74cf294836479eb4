#!/usr/bin/env python3
"""What each setting of the written case does: one change at a time, `simpleFoam` as long as it lives, a table in Markdown.

usage: case_causes.py FOLDER [--program AEROLOOM] [--ranks N] [--iterations N] [--only CASE ...] [--page FILE]

Cases are those of case_runs.py, meshed with layers at y+ 1. A run that exceeds a hundred free streams counts as dead from there. What is
there already in FOLDER is not done again. Needs OpenFOAM and, for some, gmsh.
"""
import argparse
import pathlib
import re
import shutil
import subprocess

import case_runs
import written_case
from printed_table import PrintedTable, add_page_option

#: Free streams; what is faster is dead.
DEAD = 100.0
SCHEMES = ("fvSchemes", "fvSchemes.first", "fvSchemes.second")
SOLUTIONS = ("fvSolution", "fvSolution.first", "fvSolution.second")
GRADIENTS = r"gradSchemes [^}]*}"


def replace(written, names, *changes):
    for name in names:
        path = written / "system" / name
        text = path.read_text()
        for pattern, replacement in changes:
            text, count = re.subn(pattern, replacement, text)
            if not count:
                raise SystemExit(f"{path}: no '{pattern}' there")
        path.write_text(text)


def gradients(text):
    return lambda written: replace(written, SCHEMES, (GRADIENTS, f"gradSchemes {{ {text} }}"))


def solution(*changes):
    return lambda written: replace(written, SOLUTIONS, *changes)


def throughout(name, stage):
    """A dictionary is in both stages as in one."""
    def change(written):
        for ending in ("first", "second"):
            if ending != stage:
                shutil.copy(written / f"system/{name}.{stage}", written / f"system/{name}.{ending}")
    return change


#: Name, what it does to the case.
CHANGES = (
    ("as written", lambda written: None),
    ("second order from the start", throughout("fvSchemes", "second")),
    ("first order throughout", throughout("fvSchemes", "first")),
    ("p 0.9, U 0.7, k and omega 0.6 throughout", throughout("fvSolution", "first")),
    ("p 0.5, U 0.9, k and omega 0.7 throughout", throughout("fvSolution", "second")),
    ("SIMPLE, p 0.3, U 0.6, k and omega 0.5", solution(
        (r"consistent yes; ", ""), (r"p 0\.\d", "p 0.3"), (r"U 0\.\d", "U 0.6"), (r"(nuTilda\)\") 0\.\d", r"\1 0.5"))),
    ("start from potentialFoam", "potential"),
    ("gradient of p not limited", gradients("default cellLimited Gauss linear 1; grad(p) Gauss linear;")),
    ("no gradient limited", gradients("default Gauss linear;")),
    ("gradients from corners (pointLinear), limited", gradients("default cellLimited Gauss pointLinear 1;")),
    ("gradients by least squares, limited", gradients("default cellLimited leastSquares 1;")),
    ("one corrector for non-orthogonality", solution((r"nNonOrthogonalCorrectors 0", "nNonOrthogonalCorrectors 1"))),
    ("corrections not limited", lambda written: replace(written, SCHEMES, (r"Gauss linear limited 0\.5", "Gauss linear corrected"),
                                                        (r"default limited 0\.5", "default corrected"))),
)


def launch(options, written, program, log):
    parallel = ["-parallel"] if options.ranks > 1 else []
    ranks = [case_runs.ROOT / "scripts/mpirun_local.sh", str(options.ranks)] if options.ranks > 1 else []
    environment = written_case.environment(written)
    with open(written / log, "w", encoding="utf-8") as file:
        subprocess.run([*ranks, program, *parallel], cwd=written, stdout=file, stderr=file, check=False, env=environment)


def run(options, change, source, folder):
    """A copy of the case with one change; nothing where that has run."""
    if (folder / "log.simpleFoam").exists():
        return
    if folder.exists():
        shutil.rmtree(folder)
    shutil.copytree(source, folder, ignore=shutil.ignore_patterns("postProcessing", "log.*", "[1-9]*"))
    control = folder / "system/controlDict"
    control.write_text(re.sub(r"^(endTime\s+)\d+;", rf"\g<1>{options.iterations};", control.read_text(), flags=re.MULTILINE))
    replace(folder, ("controlDict",), (r"(fields\s+\(U p k omega\);\s+writeControl\s+timeStep;\s+writeInterval\s+)10;", r"\g<1>1;"))
    if change == "potential":
        launch(options, folder, "potentialFoam", "log.potentialFoam")
    else:
        change(folder)
    launch(options, folder, "simpleFoam", "log.simpleFoam.running")
    (folder / "log.simpleFoam.running").rename(folder / "log.simpleFoam")


def judge(folder):
    log = (folder / "log.simpleFoam").read_text()
    steps = log.split("\nTime = ")[1:]
    speeds = written_case.speeds(folder)
    lived = next((i for i, speed in enumerate(speeds) if not speed < DEAD), len(speeds))
    drag = written_case.coefficients(folder).get("Cd", [])[:lived]
    continuity = re.findall(r"sum local = ([^,]+),", "".join(steps[:lived]))
    if lived == 0:
        return 0, "–", "–", "–", "–"
    return (lived, f"{max(speeds[:lived]):.3g}", f"{case_runs.fall_of(case_runs.read_residuals(steps[:lived])):.0f}",
            f"{float(continuity[-1]):.1g}" if continuity else "–", f"{drag[-1]:.4g}" if drag else "–")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default=case_runs.ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--iterations", type=int, default=150)
    parser.add_argument("--target", type=int, default=100_000, help="tetrahedra, layers not counted")
    parser.add_argument("--only", nargs="*", default=["sphere", "oneram6"], help="names of cases")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("One change at a time", ["case", "change", "iterations lived", "fastest, free streams", "residuals fall by",
                                                  "continuity, local", "drag"])
    for case in case_runs.cases():
        if case.name not in options.only:
            continue
        folder = options.folder.resolve() / case.name
        if not case_runs.mesh(options, case, 1, folder):
            table.add(case.name, "not meshed")
            continue
        for number, (name, change) in enumerate(CHANGES):
            changed = folder / f"change_{number}"
            run(options, change, folder / "out/openfoam", changed)
            table.add(case.name, name, *judge(changed))
    table.save(options.page)


if __name__ == "__main__":
    main()
