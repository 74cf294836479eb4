#!/usr/bin/env python3
"""Files of a mesh appear together or not at all: what was there before is whole where a run is killed while it writes, or has no
room for what it writes. AEROLOOM_MOMENTS: how many of either are tried, one unless set.
usage: together_test.py PROGRAM"""
import hashlib
import json
import os
import random
import resource
import subprocess
import sys
import time

from killed_run import run_and_kill
from program import COARSE_DUCT, SOURCE
from shell import Shell

FORMATS = ["vtu", "vtkhdf", "cgns", "ugrid", "su2", "su2b", "msh", "msh_parts", "meshb", "openfoam"]
MOMENTS = int(os.environ.get("AEROLOOM_MOMENTS", "1"))
CASE = COARSE_DUCT + f"output: {{pictures: false, parts: 2, formats: {json.dumps(FORMATS)}}}\n"


def files_of(folder):
    """All but what a run says of itself, by name."""
    said = {"report.json", "report.html", "tasks.csv", ".lock"}
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in said}


def check_runs(shell):
    launcher = SOURCE / "scripts" / "mpirun_local.sh"
    out = shell.folder / "out"
    (shell.folder / "case.yaml").write_text(CASE)
    code, _, error = shell.run("run case.yaml", 2)
    assert code == 0, error
    before = files_of(out)
    other = ["--set", "sizing.target_tetrahedra=2500"]
    staging = out / ".mesh.unfinished"
    for _ in range(MOMENTS):
        room = random.randint(10, 60) * 1024
        run = subprocess.Popen([launcher, "1", shell.program, "run", "case.yaml", *other], cwd=shell.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        while not staging.exists():
            assert run.poll() is None, run.stdout.read()
            time.sleep(0.001)
        resource.prlimit(run.pid, resource.RLIMIT_FSIZE, (room, room))
        text = run.communicate(timeout=200)[0]
        assert run.returncode == 7 and "File too large" in text, text
        assert ".mesh.unfinished" not in text, text
        assert files_of(out) == before, f"{room} bytes"
    # While it writes: all as before.
    for _ in range(MOMENTS):
        some = random.choice(["mesh.pvtu", "mesh.vtkhdf", "mesh.cgns", "mesh.lb8.ugrid", "mesh.su2", "mesh.msh"])
        seconds = run_and_kill(shell.program, shell.folder / "case.yaml", out, 2,
                               lambda _, some=some: (staging / some).exists() or
                               list(staging.glob(f".{some}.unfinished")), *other[1:])
        left = {name: text for name, text in files_of(out).items() if not name.startswith(".mesh.unfinished")}
        foam = {name for name in left if "polyMesh.unfinished" in name}
        left = {name: text for name, text in left.items() if name not in foam}
        assert seconds is None or left == before, some
    # What a killed run left is no hindrance, and goes.
    code, _, error = shell.run("run case.yaml", 2)
    assert code == 0 and not staging.exists(), error
    assert files_of(out) == before


def main():
    check_runs(Shell(sys.argv[1]))


if __name__ == "__main__":
    main()
