"""Runs that are killed on the way, for tests and benchmarks of checkpoints."""
import os
import pathlib
import signal
import subprocess
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def command(program, case, output, ranks, *overrides):
    words = [SOURCE / "scripts" / "mpirun_local.sh", ranks, program, "run", case, "--set", f"output.directory={output}"]
    for override in overrides:
        words += ["--set", override]
    return [str(word) for word in words]


def processes_of(output):
    """All that have the output directory on their command line."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if f"output.directory={output}".encode() in words:
            found.append(int(entry.name))
    return found


def run_and_kill(program, case, output, ranks, is_time, *overrides, killed_by=signal.SIGKILL):
    """Starts a run and kills all its processes as soon as is_time(seconds) says so. Returns the seconds it ran, or None
    where it had ended before."""
    start = time.monotonic()
    run = subprocess.Popen(command(program, case, output, ranks, *overrides), stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
    while not is_time(time.monotonic() - start):
        if run.poll() is not None:
            return None
        time.sleep(0.002)
    seconds = time.monotonic() - start
    while left := processes_of(output):
        for process in left:
            try:
                os.kill(process, killed_by)
            except ProcessLookupError:
                pass
        time.sleep(0.02 if killed_by == signal.SIGKILL else 0.5)
    run.wait()
    return seconds
