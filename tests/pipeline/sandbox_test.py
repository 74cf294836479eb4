#!/usr/bin/env python3
"""Machines that forbid child processes: told with the remedy, meshed without, and crashes end with stage and piece.
usage: sandbox_test.py PROGRAM"""
import json
import pathlib
import subprocess
import sys
import tempfile

from program import COARSE_DUCT, NO_PICTURES, SOURCE, with_fault

CASE = COARSE_DUCT + NO_PICTURES + "volume: {piece_tets: 800}\n"


def run(program, folder, *overrides, forbidden=True, fault=None):
    """Exit code and all that two ranks print."""
    command = [SOURCE / "scripts" / "mpirun_local.sh", "2"]
    if forbidden:
        command.append(SOURCE / "tests" / "pipeline" / "without_processes.py")
    command += [program, "run", "case.yaml"] + [word for one in overrides for word in ("--set", one)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, cwd=folder, env=with_fault(fault))
    return done.returncode, done.stdout + done.stderr


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    can = subprocess.run([sys.executable, "-c", "import without_processes as w; print(w.forbid_processes())"],
                         cwd=pathlib.Path(__file__).parent, capture_output=True, text=True, check=True)
    if can.stdout.strip() != "True":
        print("skipped: this machine has no filters of system calls")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="aeroloom_sandbox_") as name:
        folder = pathlib.Path(name)
        (folder / "case.yaml").write_text(CASE)
        report = folder / "out" / "report.json"

        code, text = run(program, folder)
        assert code == 8 and "Remedy: parallel.sandbox: none" in text and "Operation not permitted" in text, text

        code, text = run(program, folder, "parallel.sandbox=none")
        assert code == 0 and "ends the program" not in text and "triangulating" not in text, text
        found = json.loads(report.read_text())["mesh"]["hash"]
        code, text = run(program, folder, "parallel.sandbox=none", forbidden=False)
        assert code == 0 and json.loads(report.read_text())["mesh"]["hash"] == found, text
        code, text = run(program, folder, forbidden=False)
        assert code == 0 and json.loads(report.read_text())["mesh"]["hash"] == found, text

        for fault, where in (("zone=aborts@0", "stage volume, zone 0"), ("domain=aborts", "stage geometry, ")):
            code, text = run(program, folder, "parallel.sandbox=none", fault=fault)
            assert code != 0 and f"error: {where}" in text and "crashed with SIGABRT" in text, text


main()
