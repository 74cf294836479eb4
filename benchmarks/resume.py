#!/usr/bin/env python3
"""Kills runs at random moments and resumes them on another number of ranks; times what checkpoints cost.

usage: resume.py PROGRAM [--case FILE] [--kills 20] [--seed 1] [--repeat 3]
Prints a row for each kill and the cost of checkpoints; exits with 1 where a resumed run has another hash.
"""
import argparse
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests" / "pipeline"))
from killed_run import command, run_and_kill  # noqa: E402


def run(program, case, output, ranks, *overrides):
    """Seconds, report."""
    start = time.monotonic()
    done = subprocess.run(command(program, case, output, ranks, *overrides), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return time.monotonic() - start, json.loads((output / "report.json").read_text())


def bytes_of(*paths):
    return sum(f.stat().st_size for path in paths
               for f in ([path] if path.is_file() else path.rglob("*")) if f.is_file())


def cost(program, case, folder, repeat):
    """Runs with and without in turn; prints the least of each and the most that lay on disk."""
    plain, kept = [], []
    for _ in range(repeat):
        shutil.rmtree(folder, ignore_errors=True)
        plain.append(run(program, case, folder / "plain", 2)[0])
        kept.append(run(program, case, folder / "kept", 2, "output.checkpoints=write")[0])
    mesh = bytes_of(folder / "plain" / "mesh.pvtu", folder / "plain" / "mesh")
    left = bytes_of(folder / "kept" / "checkpoint")
    shutil.rmtree(folder / "kept")
    most = 0
    watched = subprocess.Popen(command(program, case, folder / "kept", 2, "output.checkpoints=write"),
                               stdout=subprocess.DEVNULL)
    while watched.poll() is None:
        try:
            most = max(most, bytes_of(folder / "kept" / "checkpoint"))
        except OSError:
            pass
        time.sleep(0.01)
    print(f"2 ranks, least of {repeat}: {min(plain):.2f} s without, {min(kept):.2f} s with checkpoints "
          f"({100 * (min(kept) / min(plain) - 1):+.1f} %)")
    print(f"bytes: {left / 1e6:.1f} MB left, {most / 1e6:.1f} MB at most, mesh {mesh / 1e6:.1f} MB "
          f"({left / mesh:.2f} and {most / mesh:.2f} times)")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--case", type=pathlib.Path, default=SOURCE / "configs" / "transport.yaml")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    program, case = arguments.program.resolve(), arguments.case.resolve()
    chance = random.Random(arguments.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_resume_"))
    seconds, report = run(program, case, folder / "undisturbed", 2)
    wanted, wrong = report["mesh"]["hash"], 0
    print(f"undisturbed on 2 ranks: {seconds:.1f} s, {report['mesh']['tetrahedra']} tetrahedra, hash {wanted}")
    print("| killed after s | by | on ranks | resumed on | stages found | s | hash |\n|---|---|---|---|---|---|---|")
    for _ in range(arguments.kills):
        after = None
        while after is None:  # until it is killed before it ends
            shutil.rmtree(folder / "killed", ignore_errors=True)
            ranks, moment = chance.choice([1, 2, 3]), chance.uniform(0, 1) * seconds
            by = chance.choice([signal.SIGKILL, signal.SIGTERM])
            after = run_and_kill(program, case, folder / "killed", ranks, lambda t, m=moment: t >= m,
                                 "output.checkpoints=write", killed_by=by)
        again = chance.choice([r for r in (1, 2, 3, 4) if r != ranks])
        took, report = run(program, case, folder / "killed", again, "output.checkpoints=resume")
        same = report["mesh"]["hash"] == wanted
        wrong += not same
        found = ", ".join(report.get("resumed", [])) or "none"
        print(f"| {after:.2f} | {by.name} | {ranks} | {again} | {found} | {took:.1f} | {'same' if same else 'OTHER'} |", flush=True)
    cost(program, case, folder / "cost", arguments.repeat)
    shutil.rmtree(folder)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
