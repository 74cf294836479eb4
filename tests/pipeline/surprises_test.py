#!/usr/bin/env python3
"""What comes from outside: another run in the same folder, signals, streams that are closed.
usage: surprises_test.py PROGRAM"""
import json
import os
import signal
import subprocess
import sys
import time

from program import COARSE_DUCT, COARSE_WING, NO_PICTURES, SOURCE
from shell import Shell


def start(shell, ranks, *words):
    command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), shell.program, *words]
    # mpirun waits a second before it passes a signal on, and another before it kills: little on a busy machine.
    patient = os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": "2"}
    return subprocess.Popen(command, cwd=shell.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=patient)


def report(shell, folder="out"):
    return json.loads((shell.folder / folder / "report.json").read_text())


def holder_of(lock, process):
    """The process that the lock names, once it does."""
    while not lock.exists() or len(lock.read_text().split()) < 2:
        assert process.poll() is None, process.stdout.read()
        time.sleep(0.01)
    return int(lock.read_text().split()[1])


def check_one_run_at_a_time(shell):
    """The second is told of the first; what a killed run leaves is no hindrance."""
    lock = shell.folder / "out" / ".lock"
    first = start(shell, 1, "run", "long.yaml", "--set", "sizing.surface_maximum=0.5")
    holder = holder_of(lock, first)
    code, _, error = shell.run("run case.yaml")
    assert code == 7 and "another run writes there (process" in error and "Remedy" in error, error
    os.kill(holder, signal.SIGKILL)
    first.wait()
    assert lock.exists()
    code, _, error = shell.run("run case.yaml")
    assert code == 0 and not lock.exists(), error


def check_end_from_outside(shell):
    """A message, the code of shells, and a report that says so."""
    for ranks, sent in ((1, signal.SIGTERM), (1, signal.SIGUSR1), (2, signal.SIGTERM)):
        lock = shell.folder / "out" / ".lock"
        lock.unlink(missing_ok=True)  # of the one before
        run = start(shell, ranks, "run", "long.yaml", "--set", "sizing.minimum=0.02",
                    "--set", f"sizing.surface_maximum={0.04 / ranks}")
        holder = holder_of(lock, run)
        time.sleep(0.3)
        if ranks == 1:
            os.kill(holder, sent)
        else:
            run.terminate()
        text = run.communicate(timeout=60)[0]
        # mpirun may end before it has passed on what it was told.
        if ranks == 1:
            assert f"ended by {sent.name}" in text and run.returncode == 128 + sent, (run.returncode, text)
        told = report(shell)
        assert (told["status"], told["exit_code"]) == ("failed", 128 + sent), told
        assert sent.name in told["failure"]["message"] and told["failure"]["stage"], told["failure"]


def check_closed_streams(shell):
    for closed in (">&-", "2>&-", "<&- >&- 2>&-"):
        done = subprocess.run(["bash", "-c", f'"{shell.program}" run case.yaml --set output.directory=closed {closed}'],
                              cwd=shell.folder, capture_output=True, text=True, timeout=200)
        assert done.returncode == 0, (closed, done.returncode, done.stderr)
    assert report(shell, "closed")["mesh"]["hash"] == report(shell)["mesh"]["hash"]


def main():
    shell = Shell(sys.argv[1])
    (shell.folder / "case.yaml").write_text(COARSE_DUCT + NO_PICTURES)
    (shell.folder / "long.yaml").write_text(COARSE_WING + NO_PICTURES)
    assert shell.run("run case.yaml")[0] == 0
    for check in (check_closed_streams, check_one_run_at_a_time, check_end_from_outside):
        check(shell)
        print(check.__name__, "good", flush=True)


if __name__ == "__main__":
    main()
