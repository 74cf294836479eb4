#!/usr/bin/env python3
"""Scaling studies: series that are killed and go on, tables and page, job scripts and what they leave, refusals.
usage: scaling_test.py PROGRAM"""
import csv
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time

from program import COARSE_DUCT, NO_PICTURES, SOURCE
from shell import Shell

DUCT = SOURCE / "configs" / "geometry" / "duct.step"
# By sizes, which a weak series has to scale.
SIZES = "{minimum: 0.2, feature_minimum: 0.2, maximum: 0.4, growth: 1.9, proximity: 0}"
CASE = COARSE_DUCT.replace(str(DUCT), "duct.step").replace("{target_tetrahedra: 2000}", SIZES) + NO_PICTURES
LAUNCHER = SOURCE / "scripts" / "mpirun_local.sh"


def study(shell, folder="out"):
    return json.loads((shell.folder / folder / "scaling.json").read_text())


def processes_in(folder):
    found = []
    for entry in os.listdir("/proc"):
        try:
            words = open(f"/proc/{entry}/cmdline", "rb").read() if entry.isdigit() else b""
        except OSError:
            continue
        if f"{folder}/out/runs".encode() in words:
            found.append(int(entry))
    return found


def check_series(shell):
    """Killed, then ended from outside, it goes on where it stopped; nothing runs on."""
    line = "scaling case.yaml --ranks 1,2 --repeats 1 --series strong,weak"
    first = line.removesuffix(",weak")  # whose sizes are sought by forecasts, which take time
    for killed_by, awaited in ((signal.SIGKILL, "serial_1_1"), (signal.SIGTERM, "strong_2_1")):
        run = subprocess.Popen([shell.program, *shlex.split(first)], cwd=shell.folder, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
        while not (shell.folder / "out" / "runs" / awaited / "marks").exists():
            assert run.poll() is None, run.stdout.read()
            time.sleep(0.01)
        run.send_signal(killed_by)
        run.communicate(timeout=60)
        assert run.returncode != 0
        if killed_by == signal.SIGTERM:
            assert run.returncode == 143 and not processes_in(shell.folder), (run.returncode, processes_in(shell.folder))
    code, text, error = shell.run(line)
    assert code == 0 and "done before" in text, text + error
    assert not processes_in(shell.folder)
    told = study(shell)
    rows = {(row["series"], row["ranks"]): row for row in told["rows"]}
    assert set(rows) == {("serial", 1), ("strong", 1), ("strong", 2), ("weak", 1), ("weak", 2)}, rows.keys()
    assert all(row["ended"] == 1 and row["failed"] == 0 for row in rows.values()), rows
    assert rows["strong", 1]["hash"] == rows["strong", 2]["hash"] == rows["weak", 1]["hash"]
    assert rows["strong", 2]["speedup"] > 0 and rows["strong", 1]["speedup_of_series"] == 1
    # The case gives sizes: they are scaled until as many are forecast for each rank, roughly for so coarse a mesh.
    assert 0.6 < rows["weak", 2]["tetrahedra"] / 2 / rows["weak", 1]["tetrahedra"] < 1.5, rows
    assert max(run["attempts"] for run in told["runs"]) >= 2, told["runs"]
    for run in told["runs"]:
        left = {path.name for path in (shell.folder / "out" / "runs" / run["name"]).iterdir()}
        assert {"report.json", "marks", "log"} <= left and not any(name.startswith("mesh") for name in left), left
    with open(shell.folder / "out" / "scaling.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 5 and all(float(row["volume_wall_seconds"]) > 0 for row in lines), lines
    page = (shell.folder / "out" / "scaling.html").read_text()
    assert "Speed-up of the strong series" in page and "://" not in page
    began = time.monotonic()
    code, text, _ = shell.run(line)
    assert code == 0 and text.count("done before") == 5 and time.monotonic() - began < 30, text


def check_comparison(shell):
    code, text, error = shell.run("scaling --compare out out/scaling.json")
    assert code == 0 and text.count("the same") == 5 and "1.000" in text, text + error


def check_refusals(shell):
    """Those that need a study; tests/pipeline/refusals_test.cpp has the others."""
    for line, code, words in (("scaling case.yaml --ranks 1 --set sizing.maximum=9", 2, "holds a study of another case"),
                              ("scaling --predict out/runs/strong_1_1 --network case.yaml", 7, "--measure-network")):
        ended, text, error = shell.run(line)
        assert ended == code and words in error, (line, ended, text, error)
    # Of the same case, but for what its geometry file holds.
    (shell.folder / "duct.step").write_bytes(DUCT.read_bytes() + b"\n")
    ended, text, error = shell.run("scaling case.yaml --ranks 1 --repeats 1")
    assert ended == 2 and "has changed since" in error and "done before" not in text, (ended, text, error)
    shutil.copy(DUCT, shell.folder)


def busy_seconds(stage):
    """CPU of the busiest rank."""
    return stage["cpu_seconds_max"] + stage["check_seconds"] + stage["other_seconds"]


def check_prediction(shell):
    """The record of a run foretells that run; a network is measured and used; a study has both."""
    for ranks, tolerance in ((1, 0.01), (2, 0.15)):
        folder = shell.folder / "out" / "runs" / f"strong_{ranks}_1"
        code, text, error = shell.run(f"scaling --predict {folder}")
        assert code == 0 and "80 % efficiency" in text and "granularity" in text, text + error
        told = json.loads((folder / "prediction.json").read_text())
        rows = {row["ranks"]: row for row in told["rows"]}
        assert set(rows) == {2**i for i in range(14)} | {10000} and told["recorded_ranks"] == ranks
        report = json.loads((folder / "report.json").read_text())
        for stage, predicted in zip(report["stages"], rows[ranks]["stages"], strict=True):
            assert stage["name"] == predicted["name"]
            busy = busy_seconds(stage)
            assert abs(predicted["busy_cpu_seconds"] - busy) < tolerance * busy + 0.02 * ranks, (ranks, stage, predicted)
        for row in told["rows"]:
            lost = sum(row["losses"].values())
            assert abs(row["seconds"] - rows[1]["seconds"] / row["ranks"] - lost) < 1e-6 * rows[1]["seconds"], row
        assert rows[10000]["losses"]["communication"] > rows[2]["losses"]["communication"] > 0
        assert report["scaling"]["ranks_at_80_percent"] == told["ranks_at_80_percent"] >= 1
        assert report["scaling"]["bytes_per_rank"] == told["bytes_per_rank"] > 1e7
    code, text, error = shell.run("scaling --measure-network network.json", ranks=2)
    network = json.loads((shell.folder / "network.json").read_text())
    assert code == 0 and 0 < network["latency_seconds"] < 0.1 and network["bytes_per_second"] > 1e6, text + error
    record = "out/runs/strong_1_1"
    code, text, error = shell.run(f"scaling --predict {record} --ranks 64,8 --network network.json")
    told = json.loads((shell.folder / record / "prediction.json").read_text())
    assert code == 0 and [row["ranks"] for row in told["rows"]] == [8, 64], text + error
    assert told["latency_seconds"] == network["latency_seconds"]
    with open(shell.folder / record / "prediction.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    assert {line["ranks"] for line in lines} == {"8", "64"} and lines[-1]["stage"] == "all"
    assert [row["ranks"] for row in study(shell)["prediction"]["rows"]] == [1, 2, 4, 8]
    page = (shell.folder / "out" / "scaling.html").read_text()
    assert "Predicted from" in page and ">predicted<" in page
    code, text, error = shell.run("check case.yaml --set output.directory=checked")
    told = json.loads((shell.folder / "checked" / "check.json").read_text())["forecast"]["scaling"]
    assert code == 0 and "80 % efficiency" in text and told["ranks_at_80_percent"] >= 1, text + error


def check_failures_are_shown(shell):
    code, text, error = shell.run("scaling case.yaml --ranks 1 --repeats 1 --no-serial --set output.directory=bad",
                                  fault="zone=aborts")
    assert code == 5 and "failed with code 5" in text, (code, text + error)
    run, = study(shell, "bad")["runs"]
    assert run["state"] == "failed" and run["exit_code"] == 5 and run["said"].startswith("stage volume"), run
    assert "stage volume" in (shell.folder / "bad" / "scaling.html").read_text()


def check_jobs(shell):
    """Scripts are run here as a queue would run them; one is not, and is shown as planned. Folders have names of which a shell,
    or YAML, would make more."""
    out, jobs = "of jobs: #1 $(touch executed) `touch executed`", "jobs; touch executed"
    code, text, error = shell.run(f"scaling case.yaml --ranks 1,2 --repeats 1 --set 'output.directory=\"{out}\"' "
                                  f"--write-jobs '{jobs}' --launcher 'X={{ranks}}; {LAUNCHER} $X {{command}}'")
    assert code == 0, text + error
    for name in ("serial_1_1.slurm", "strong_2_1.sh"):
        done = subprocess.run(["bash", shell.folder / jobs / name], capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
    code, text, error = shell.run(f"scaling --collect '{jobs}'")
    assert code == 0, text + error
    states = {run["name"]: run["state"] for run in study(shell, out)["runs"]}
    assert states == {"serial_1_1": "ended", "strong_1_1": "planned", "strong_2_1": "ended"}, states
    rows = {(row["series"], row["ranks"]): row for row in study(shell, out)["rows"]}
    mesh = {(row["series"], row["ranks"]): row for row in study(shell)["rows"]}["strong", 2]["hash"]
    assert rows["strong", 2]["hash"] == mesh, (rows, mesh)
    assert not (shell.folder / out / "runs" / "strong_2_1" / "checkpoint").exists()
    # A run that ended with 0 and left no report has failed, in words and by a code of the program.
    (shell.folder / out / "runs" / "strong_2_1" / "report.json").unlink()
    code, text, error = shell.run(f"scaling --collect '{jobs}'")
    assert code == 7 and "strong_2_1 failed with code 0: ended with 0 without a report" in text + error, (code, text, error)
    assert not list(shell.folder.rglob("executed"))


def main():
    shell = Shell(sys.argv[1])
    (shell.folder / "case.yaml").write_text(CASE)
    shutil.copy(DUCT, shell.folder)
    for check in (check_series, check_comparison, check_prediction, check_refusals, check_failures_are_shown, check_jobs):
        check(shell)
        print(check.__name__, "good", flush=True)


if __name__ == "__main__":
    main()
