#!/usr/bin/env python3
"""What checkMesh makes of cases of the mixed mesh: decomposed, binary with labels of 32 and 64 bits, text, in
one part, and in parts that end between regions. What solvers make of two of them as they stand.

usage: openfoam_oracle.py WRITE_GMSH_OPENFOAM
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

RANKS = {"binary": 3, "text": 3, "wide": 3, "whole": 1, "regions": 4}


def call(case, ranks, *command):
    """What a program of OpenFOAM says; it must end well."""
    if ranks > 1:
        launcher = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "mpirun_local.sh"
        command = [launcher, str(ranks), *command, "-parallel"]
    environment = os.environ | {"PWD": str(case), "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}
    result = subprocess.run(command, cwd=case, env=environment, capture_output=True, text=True, timeout=100)
    text = result.stdout + result.stderr
    assert result.returncode == 0, text
    return text


def solve(case, ranks):
    """Flow about it, with what was written beside the mesh."""
    assert re.search(r"Continuity error = \S+", call(case, ranks, "potentialFoam"))
    control = case / "system" / "controlDict"
    control.write_text(control.read_text().replace("endTime         1000;", "endTime         5;"))
    text = call(case, ranks, "simpleFoam")
    assert "Warning" not in text, text
    for field in ("Ux", "p", "k", "omega"):
        found = re.findall(rf"Solving for {field}, Initial residual = (\S+), Final", text)
        assert len(found) >= 5 and all(0 <= float(value) <= 1 for value in found), text
    assert "bounding" not in text.split("Time = 4")[1], text


def run_as_written(case):
    """The script beside the mesh, with second order after three iterations and not after a hundred."""
    control = case / "system" / "controlDict"
    text = control.read_text().replace("endTime         1000;", "endTime         6;")
    control.write_text(text.replace("(50 ", "(3 "))
    local = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
             "HWLOC_COMPONENTS": "-pci"}
    done = subprocess.run([case / "run.sh"], env=os.environ | local, capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stdout + done.stderr + (case / "log.simpleFoam").read_text()
    assert "Mesh OK" in done.stdout and "Time = 6" in done.stdout and "Cd" in done.stdout, done.stdout
    for name in ("fvSchemes", "fvSolution"):
        taken, first, second = ((case / "system" / (name + ending)).read_text() for ending in ("", ".first", ".second"))
        assert taken == second != first, f"{name}.second was not taken"


def check(case, ranks, zone):
    text = call(case, ranks, "checkMesh", "-allTopology")
    assert "Mesh OK." in text and "***" not in text, text
    for pattern in (r"cells: +160\n", r"hexahedra: +4\n", r"prisms: +32\n", r"pyramids: +20\n", r"tetrahedra: +104\n",
                    r"wing___lower_side +40 ", r"symmetry_patch +13 ", r"far_field +83 ", rf"interface +{zone} ",
                    r"lower_layer +64 ", r"upper +96 ", r"Upper triangular ordering OK",
                    r"Total volume = 120.078125"):
        assert re.search(pattern, text), f"{case}: no '{pattern}' in\n{text}"


def main(writer):
    with tempfile.TemporaryDirectory() as name:
        subprocess.run([writer, name], check=True, timeout=60)
        for case, ranks in RANKS.items():
            # Both parts count a face of a zone that lies between them.
            check(pathlib.Path(name) / case, ranks, 64 if case == "regions" else 32)
        for case in ("binary", "whole"):
            copy = pathlib.Path(name) / f"{case}_as_written"
            shutil.copytree(pathlib.Path(name) / case, copy)
            run_as_written(copy)
            solve(pathlib.Path(name) / case, RANKS[case])
    print("checkMesh and solvers agree")


if __name__ == "__main__":
    if shutil.which("checkMesh") is None:
        sys.exit(77)
    main(sys.argv[1])
