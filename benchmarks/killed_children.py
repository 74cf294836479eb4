#!/usr/bin/env python3
"""What the machine does to a child changes no mesh: children of a run are killed or stopped at random moments, on 1 to 3 ranks.

usage: killed_children.py [--runs N] [--program AEROLOOM] [--seed N]

Each run must end with the mesh of a run that was left alone, or with an error; ends with a line RESULT, exit code 0 if all did.
"""
import argparse
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "pipeline"))
from killed_run import command, processes_of  # noqa: E402

# Many zones, each a child; CAD from a file, which a child prepares.
CASE = f"""
geometry: {{file: "{ROOT}/tests/data/wing_body.step", trailing_edges: sharpen}}
farfield: {{shape: box, extent: 3}}
sizing: {{minimum: 0.1, maximum: 10, surface_maximum: 0.4, curvature_angle: 20, growth: 1.6, proximity: 0}}
volume: {{piece_tets: 5000}}
output: {{pictures: false, formats: [su2b]}}
"""


def parent_of(process):
    try:
        return int((pathlib.Path("/proc") / str(process) / "stat").read_text().rsplit(")", 1)[1].split()[1])
    except (OSError, IndexError):
        return -1


def is_launcher(process):
    try:
        return b"mpirun" in pathlib.Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")[0]
    except OSError:
        return True  # it is gone


def children_of(output):
    """A child is started by the server of a rank, which that rank has started."""
    ours = {process: parent_of(process) for process in processes_of(output)}
    programs = {process for process in ours if not is_launcher(process)}
    return [p for p in programs if ours[p] in programs and ours.get(ours[p]) in programs]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--program", default=ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random.seed(options.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_children_"))
    case = folder / "case.yaml"
    case.write_text(CASE)
    alone = folder / "alone"
    subprocess.run(command(options.program, case, alone, 2), check=True, stdout=subprocess.DEVNULL)
    wanted = json.loads((alone / "report.json").read_text())["mesh"]["hash"]
    counts = {"same": 0, "error": 0, "other": 0, "missed": 0}
    for index in range(options.runs):
        ranks, output = 1 + index % 3, folder / f"run_{index}"
        how = random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGSTOP, signal.SIGTERM])
        patience = random.uniform(0, 2)
        began = time.monotonic()
        run = subprocess.Popen(command(options.program, case, output, ranks), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)
        struck = 0
        while run.poll() is None and not struck:
            if time.monotonic() - began > patience:
                for child in children_of(output)[:1]:
                    try:
                        os.kill(child, how)
                        struck = child
                    except ProcessLookupError:
                        pass
            time.sleep(0.002)
        text = run.communicate(timeout=600)[0]
        if run.returncode == 0:
            found = json.loads((output / "report.json").read_text())["mesh"]["hash"]
            outcome = ("same" if found == wanted else "other") if struck else "missed"
        else:
            outcome = "error"
        counts[outcome] += 1
        print(f"{index}: {ranks} rank(s), {how.name} after {patience:.2f} s: {outcome}, exit {run.returncode}, "
              f"{time.monotonic() - began:.1f} s" + ("" if outcome == "same" else "\n" + text[-600:]), flush=True)
    print("RESULT " + " ".join(f"{name}={count}" for name, count in counts.items()))
    sys.exit(0 if counts["other"] == 0 else 1)


if __name__ == "__main__":
    main()
