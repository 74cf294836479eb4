#!/usr/bin/env python3
"""Lift by Code_Saturne on a mesh that OpenFOAM has run on: k-omega SST, steady, from the conditions of the case as the program wrote it.

usage: saturne_flow.py MESH WRITTEN FOLDER [--iterations 300] [--program AEROLOOM] [--tools DIR] [--include DIR] [--page FILE]

MESH is anything that `aeroloom convert` reads, a CGNS file included, WRITTEN the case of OpenFOAM with that mesh, as run. The solver starts
from uniform flow, 20 iterations of first order. The far field is an inlet where the free stream flows in, else an outlet. Needs Debian's
packages code-saturne and code-saturne-include and a C compiler: saturne_flow.c is loaded before the solver's library. Called again, it
goes by what is there. Ends with a line RESULT; the exit code says whether lift, the mean of the last 50 iterations, lies within 3 % of
OpenFOAM's and is steady to 3 %.
"""
import argparse
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys

import saturne_mesh
import written_case
from potential_flow import ROOT, run

sys.path.append(str(ROOT / "benchmarks"))
from printed_table import PrintedTable, add_page_option  # noqa: E402

FIRST_ORDER, LAST, SHARE = 20, 50, 0.03


def conditions(written):
    """Words of 0.orig/conditions by name, vectors as lists of numbers."""
    found = {}
    for name, value in re.findall(r"^(\w+)\s+([^;]+);", (written / "0.orig" / "conditions").read_text(), re.MULTILINE):
        numbers = re.findall(r"[-+.\deE]+", value)
        found[name] = [float(number) for number in numbers] if value.startswith("(") else value
    return found


def patches(written):
    """Names of patches by the group of 0.orig's fields that they are in. The case adds `_patch` to names that are those of groups."""
    found = {"wall": [], "symmetry": [], "farfield": []}
    text = (written / "constant" / "polyMesh" / "boundary").read_text()
    for name, body in re.findall(r"(\S+)\s*\{([^}]*)\}", text[text.index("("):]):
        groups = re.search(r"inGroups\s+\d+\(([^)]*)\)", body)
        group = groups.group(1).split()[0] if groups else name
        if group not in found:
            sys.exit(f"{written}: patch '{name}' is neither a wall nor symmetry nor far field")
        found[group].append(name.removesuffix("_patch") if name.removesuffix("_patch") == group else name)
    return found


def write_flow(folder, written, iterations):
    """flow.h: what saturne_flow.c is compiled with."""
    values, names = conditions(written), patches(written)
    defined = {"VELOCITY": "{" + ", ".join(f"{part:.12g}" for part in values["velocity"]) + "}", "VISCOSITY": values["viscosity"],
               "K": values["k"], "OMEGA": values["omega"], "ITERATIONS": iterations, "FIRST_ORDER": FIRST_ORDER}
    for group, members in names.items():
        defined[group.upper()] = '"' + (" or ".join(members) or "none") + '"'
    (folder / "flow.h").write_text("".join(f"#define {name} {value}\n" for name, value in defined.items()))


def coefficients(folder, written):
    """Lift, drag and the largest speed over that of the free stream, by iteration."""
    values = conditions(written)
    speed = math.hypot(*values["velocity"])
    pressure = 0.5 * speed**2 * float(values["reference_area"])
    rows = [[float(word) for word in line.split(",")] for line in (folder / "forces.csv").read_text().splitlines()]
    along = [[sum(a * b for a, b in zip(row[1:4], values[direction])) / pressure for row in rows]
             for direction in ("lift_direction", "drag_direction")]
    return *along, [row[4] / speed for row in rows]


def solve(folder, options):
    saturne_mesh.preprocess(options, folder)
    write_flow(folder, options.written, options.iterations)
    source = pathlib.Path(__file__).resolve().with_suffix(".c")
    run(["mpicc", "-DHAVE_CONFIG_H", "-O2", "-shared", "-fPIC", f"-I{options.include}", f"-I{options.include / 'code_saturne'}", "-I.", source,
         "-o", "user.so"], folder, "log.compile")
    (folder / "forces.csv").unlink(missing_ok=True)
    with open(folder / "log.solve", "w", encoding="utf-8") as log:
        return subprocess.run([options.tools / "cs_solver"], cwd=folder, stdout=log, stderr=log, check=False,
                              env=os.environ | {"LD_PRELOAD": str(folder / "user.so"), "OMP_NUM_THREADS": "1"}).returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("written", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--iterations", type=int, default=300)
    saturne_mesh.add_options(parser)
    parser.add_argument("--include", type=pathlib.Path, default=pathlib.Path("/usr/include"))
    add_page_option(parser)
    options = parser.parse_args()
    if options.iterations < 2 * LAST:
        parser.error(f"--iterations: at least {2 * LAST}, for two means")
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    done = folder / "forces.csv"
    if not (done.exists() and len(done.read_text().splitlines()) >= options.iterations) and solve(folder, options):
        sys.exit(f"{folder}: cs_solver failed; see run_solver.log there")
    lifts, drags, speeds = coefficients(folder, options.written)
    other = written_case.coefficients(options.written)
    table = PrintedTable("Lift by two solvers", ("solver", "iterations", "lift", "drag", "fastest, free streams"))
    means = {}
    for name, lift, drag, fastest in (("Code_Saturne", lifts, drags, speeds),
                                      ("OpenFOAM", other["Cl"], other["Cd"], written_case.speeds(options.written))):
        means[name] = statistics.fmean(lift[-LAST:])
        table.add(name, len(lift), f"{means[name]:.5g}", f"{statistics.fmean(drag[-LAST:]):.5g}", f"{fastest[-1]:.2f}")
    table.save(options.page)
    off = means["Code_Saturne"] / means["OpenFOAM"] - 1
    before = statistics.fmean(lifts[-2 * LAST:-LAST])
    steady = abs(means["Code_Saturne"] - before) <= SHARE * abs(means["Code_Saturne"])
    ok = len(lifts) == options.iterations and abs(off) <= SHARE and steady
    print(f"RESULT iterations={len(lifts)} lift={means['Code_Saturne']:.5g} lift_off={off:+.4f} steady={int(steady)} ok={int(ok)}")
    sys.exit(0 if ok else 1)


if __name__ == "__main__":
    main()
