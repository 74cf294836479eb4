#!/usr/bin/env python3
"""A scaling study as jobs of a real queue on several hosts: written, submitted, collected on the way and at the end, the mesh
that of one rank. One job is cancelled, and one runs out of time and submits itself anew. usage: study_test.py PROGRAM"""
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

from cluster import SHARED, Cluster, obstacle
from cluster_test import CASE, GEOMETRY, HOSTS, SKIPPED, Queue, check_nothing_left, prepare, wait_until
from program import Run


def states(cluster, queue, code=0):
    queue.shell(f"cd {SHARED} && aeroloom scaling --collect jobs", code)
    told = json.loads((cluster.shared / "study" / "scaling.json").read_text())
    return {run["name"]: run for run in told["runs"]}


def wait_for_queue(cluster, queue):
    logs = lambda: "\n".join(path.read_text() for path in (cluster.shared / "jobs").glob("*.out"))
    wait_until(lambda: queue.shell("squeue --noheader").strip() == "", 90, logs)


def check_study(cluster, queue, wanted):
    (cluster.shared / "header").write_text("#SBATCH --comment=study\n")
    queue.shell(f"cd {SHARED} && aeroloom scaling case.yaml --ranks 1,3 --repeats 1 --no-serial --ranks-per-node 1 "
                "--set output.directory=study --write-jobs jobs --job-header header")
    script = cluster.shared / "jobs" / "strong_3_1.slurm"
    text = script.read_text()
    assert "--nodes=3" in text and "--comment=study" in text, text
    assert {run["state"] for run in states(cluster, queue).values()} == {"planned"}
    # One is cancelled on the way, and submitted again.
    submitted = queue.shell(f"cd {SHARED} && sh jobs/submit.sh && cat jobs/submitted")
    job = re.search(r"^strong_3_1 (\d+)$", submitted, re.MULTILINE)[1]
    marks = cluster.shared / "study" / "runs" / "strong_3_1" / "marks"
    wait_until((marks.parent / "checkpoint" / "sizing.checkpoint").exists, 60, lambda: queue.shell("squeue"))
    queue.shell(f"scancel --full {job}")
    wait_for_queue(cluster, queue)
    run = states(cluster, queue, 143)["strong_3_1"]
    assert run["state"] == "failed" and run["exit_code"] == 143 and "SIGTERM" in run["said"], run
    out = (cluster.shared / "jobs" / "strong_3_1.out").read_text()
    assert "strong_3_1 ended with 143; it goes on from its checkpoints with: " in out and out.strip().endswith("--resume"), out
    # The other has had its time, but for what the queue tells it of.
    queue.shell(f"sbatch {SHARED}/jobs/strong_3_1.slurm")
    wait_until(lambda: marks.read_text().count("begin") == 2, 60, lambda: queue.shell("squeue"))
    queue.shell("scancel --batch --signal=USR1 --name=strong_3_1")
    wait_for_queue(cluster, queue)
    ended = states(cluster, queue)
    assert {run["state"] for run in ended.values()} == {"ended"} and {run["hash"] for run in ended.values()} == {wanted}, ended
    out = (cluster.shared / "jobs" / "strong_3_1.out").read_text()
    assert "time is over; goes on as job" in out and ended["strong_3_1"]["attempts"] == 3, (out, ended)
    log = (cluster.shared / "study" / "runs" / "strong_3_1" / "log").read_text()
    assert "stage sizing from" in log, log


def main():
    if why := obstacle():
        print("skipped:", why)
        sys.exit(SKIPPED if "CI" not in os.environ or "unshare" in why else 1)
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    shutil.copy(GEOMETRY, folder)
    alone = Run(program, CASE, folder=folder)
    assert alone.code == 0, alone.text
    with Cluster(folder / "cluster") as cluster:
        cluster.up(HOSTS, tied=True)
        cluster.slurm()
        prepare(cluster, program, CASE)
        check_study(cluster, Queue(cluster), alone.report["mesh"]["hash"])
        check_nothing_left(cluster)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
