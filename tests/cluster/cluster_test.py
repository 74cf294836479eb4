#!/usr/bin/env python3
"""Several hosts with a real queue: the commands of docs/clusters.md give the mesh of one rank; a cancelled job goes on; no
host is left with anything. usage: cluster_test.py PROGRAM"""
import os
import pathlib
import re
import shutil
import sys
import tempfile
import time

from cluster import SHARED, Cluster, obstacle

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from program import COARSE_WING, NO_PICTURES, SOURCE, Run  # noqa: E402

SKIPPED = 77
HOSTS = 3
# Beside its geometry, which hosts may not see where it is.
GEOMETRY = SOURCE / "tests" / "data" / "wing_body.step"
PIECES = "surface: {piece_triangles: 100}\nvolume: {piece_tets: 1000}\n"
CASE = COARSE_WING.replace(str(GEOMETRY), GEOMETRY.name) + PIECES + NO_PICTURES
DAEMONS = ("munged", "slurmctld", ": slurmscriptd", "slurmd")


def block(word):
    """The commands of the page under this word."""
    page = (SOURCE / "docs" / "clusters.md").read_text()
    found = re.findall(rf"^```sh {word}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert len(found) == 1, f"{word}: {len(found)} blocks"
    return found[0]


def wait_until(condition, seconds, words):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"not within {seconds} seconds: {words()}"
        time.sleep(0.05)


class Queue:
    """As a user sees it, from node1."""

    def __init__(self, cluster):
        self.cluster = cluster

    def shell(self, text, code=0):
        done = self.cluster.on("node1", "bash", "-e", "-c", text, timeout=60)
        assert done.returncode == code, f"{text}: {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    def text(self, job):
        log = self.cluster.shared / f"mesh.{job}.log"
        return log.read_text() if log.exists() else ""

    def state(self, job):
        return re.search(r"JobState=(\w+)", self.shell(f"scontrol show job {job}"))[1]

    def wait(self, job, state):
        ended = ("COMPLETED", "FAILED", "CANCELLED", "NODE_FAIL", "TIMEOUT")
        wait_until(lambda: self.state(job) in ended, 60, lambda: self.text(job))
        assert self.state(job) == state, f"{self.state(job)}: {self.text(job)}"


def prepare(cluster, program, case):
    """The program, found on all hosts, and a case in the shared place; root may run Open MPI's programs."""
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_mpi_yield_when_idle"):
        os.environ[f"OMPI_{name}"] = "1"
    os.environ["SCRATCH"] = str(SHARED)
    os.environ["PATH"] = f"{SHARED}:{os.environ['PATH']}"
    shutil.copy(program, cluster.shared / "aeroloom")
    shutil.copy(GEOMETRY, cluster.shared)
    (cluster.shared / "case.yaml").write_text(case)
    (cluster.shared / "mesh.sh").write_text(block("mesh.sh"))


def hash_of(text):
    return re.search(r"^hash: (\w{32})$", text, re.MULTILINE)[1]


def left_on(cluster, hosts=None):
    """Processes and files of ended runs, by host."""
    left = {}
    for host in hosts or cluster.hosts():
        files = cluster.on(host, "find", "/tmp", "/dev/shm", "-mindepth", "1").stdout.split()
        left[host] = files + [w for w in cluster.processes(host).values() if not w.startswith(DAEMONS)]
    return {host: found for host, found in left.items() if found}


def check_nothing_left(cluster):
    wait_until(lambda: not left_on(cluster), 10, lambda: left_on(cluster))


def check_srun(cluster, queue, wanted):
    """On all hosts, over their links."""
    before = cluster.counters()
    text = queue.shell(f"cd {SHARED} && {block('srun')}")
    assert hash_of(text) == wanted, text
    moved = {host: sum(now) - sum(before[host]) for host, now in cluster.counters().items()}
    assert min(moved.values()) > 1_000_000, f"no work went over the links: {moved}"
    print("bytes over each link", moved)


def check_batch(cluster, queue, wanted):
    """The same script once more after the job was cancelled."""
    submit = f"cd {SHARED} && {block('submit')}"
    first = queue.shell(submit).split()[-1]
    kept = cluster.shared / "wing" / "checkpoint"
    wait_until((kept / "sizing.checkpoint").exists, 40, lambda: queue.text(first))
    queue.shell(f"scancel {first}")
    queue.wait(first, "CANCELLED")
    wait_until(lambda: "error: ended by SIGTERM" in queue.text(first), 10, lambda: queue.text(first))
    check_nothing_left(cluster)
    second = queue.shell(submit).split()[-1]
    queue.wait(second, "COMPLETED")
    text = queue.text(second)
    assert hash_of(text) == wanted and "stage sizing from" in text, text


def main():
    if why := obstacle():
        print("skipped:", why)
        sys.exit(SKIPPED if "CI" not in os.environ or "unshare" in why else 1)
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    shutil.copy(GEOMETRY, folder)
    alone = Run(program, CASE, folder=folder)
    assert alone.code == 0, alone.text
    wanted = alone.report["mesh"]["hash"]
    with Cluster(folder / "cluster") as cluster:
        cluster.up(HOSTS, tied=True)
        cluster.slurm()
        prepare(cluster, program, CASE)
        check_srun(cluster, Queue(cluster), wanted)
        check_nothing_left(cluster)
        check_batch(cluster, Queue(cluster), wanted)
        check_nothing_left(cluster)
    assert not (folder / "cluster").exists()
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
