#!/usr/bin/env python3
"""What breaks a run on several hosts, and what is left: the table of benchmarks/results/cluster_failures.md. Needs root and `scripts/setup.sh --cluster`.

usage: cluster_failures.py PROGRAM [--only WORD] [--launcher NAME] [--limit 120] [--slurm KEY=VALUE] [--mca KEY=VALUE]
           [--sysctl KEY=VALUE] [--verbose] [--page FILE]
A cluster of three hosts is made for each row, and a run of four ranks on it is harmed once its surface is there. Prints Markdown.
"""
import argparse
import os
import pathlib
import re
import signal
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests" / "cluster"))
from cluster import SHARED, Cluster, obstacle  # noqa: E402
from cluster_test import block, left_on, prepare  # noqa: E402
from printed_table import PrintedTable, add_page_option  # noqa: E402

REQUEUED = "mpirun, requeued"
LAUNCHERS = ["srun", "mpirun", REQUEUED]
# Long enough to be harmed: a minute on two cores.
CASE = """
geometry: {builtin: transport, trailing_edges: sharpen}
farfield: {shape: box, extent: 3}
sizing: {target_tetrahedra: 3000000}
output: {pictures: false}
"""


class Job:
    """A run under srun, or under mpirun in a batch job."""

    def __init__(self, cluster, launcher):
        self.cluster, self.launcher = cluster, launcher
        self.log = cluster.shared / "log"
        if launcher == "srun":
            command = block("srun").strip() + " --checkpoints"
        else:
            if launcher == REQUEUED:  # a run that ends first, by its own means, is not queued again
                script = cluster.shared / "mesh.sh"
                script.write_text(re.sub(r"export OMPI_MCA_oob_.*\n", "", script.read_text()))
            requeue = "--requeue" if launcher == REQUEUED else "--no-requeue"
            command = f"sbatch {requeue} --time=10 --open-mode=append --output={SHARED}/log mesh.sh"
        with open(self.log, "wb") as log:
            self.process = cluster.start("node1", "bash", "-c", f"cd {SHARED} && exec {command}", stdout=log, stderr=log)
        self.number = 1

    def text(self):
        return self.log.read_text(errors="replace") if self.log.exists() else ""

    def fields(self):
        words = self.cluster.on("node1", "scontrol", "show", "job", "-o", self.number).stdout.split()
        return dict(word.split("=", 1) for word in words if "=" in word)

    def ended(self):
        """What the end was, or None."""
        fields = self.fields()
        if self.launcher == "srun":
            code = self.process.poll()
            return None if code is None else f"{code}, {fields['JobState']}"
        if fields["JobState"] in {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING"}:
            return None
        code, number = fields["ExitCode"].split(":")
        return (code if number == "0" else f"signal {number}") + f", {fields['JobState']}"


def ranks_of(cluster, host):
    return [number for number, words in cluster.processes(host).items()
            if re.match(r"(/\S*/)?aeroloom run", words)]


def in_words(left):
    """What is left, by name."""
    parts = []
    for host, found in left.items():
        names = [word if word.startswith(("/tmp", "/dev/shm")) else word.split()[0].rpartition("/")[2] for word in found]
        tops = ["/".join(name.split("/")[:4 if name.startswith("/dev") else 3]) for name in names]
        parts.append(f"{host}: {', '.join(sorted(set(tops)))}")
    return "; ".join(parts)


def kill_rank(cluster, job):
    os.kill(min(ranks_of(cluster, "node3")), signal.SIGKILL)


def signal_job(*options):
    return lambda cluster, job: cluster.on("node1", "scancel", *options, job.number)


HARM = {
    "power lost": lambda cluster, job: cluster.kill("node3"),
    "host frozen": lambda cluster, job: cluster.freeze("node3"),
    "link cut": lambda cluster, job: cluster.cut("node3"),
    "rank killed": kill_rank,
    "`scancel` (SIGTERM)": signal_job(),
    "`scancel --signal=USR1`": signal_job("--signal=USR1"),
    "`--signal=B:USR1`": signal_job("--batch", "--signal=USR1"),
}
# What loses the host, and how it comes back.
LOST = {
    "power lost": None,
    "host frozen": lambda cluster: cluster.thaw("node3"),
    "link cut": lambda cluster: cluster.join("node3"),
}


def wait_for(condition, seconds):
    """The seconds until it holds, or None."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > seconds:
            return None
        time.sleep(0.1)
    return time.monotonic() - start


def words_of(text):
    """The last line of the run, or of what started it, that tells of an end."""
    told = re.findall(r"^(?:error|srun: error|slurmstepd\S* error|mpirun noticed|hash: ).*", text, re.MULTILINE)
    return told[-1][:110].replace("|", "/") if told else "nothing"


def first_times(conditions, limit):
    """After how many seconds each held for the first time, in words. A requeued run has new ranks: once is enough."""
    start, found = time.monotonic(), {}
    while len(found) < len(conditions) and (passed := time.monotonic() - start) < limit:
        found |= {name: f"{passed:.0f}" for name, holds in conditions.items() if name not in found and holds()}
        time.sleep(0.1)
    return {name: found.get(name, f"not in {limit:.0f}") for name in conditions}


def measure(program, launcher, name, arguments):
    hosts = 4 if launcher == REQUEUED else 3
    with tempfile.TemporaryDirectory(prefix="aeroloom_cluster_") as folder, Cluster(f"{folder}/hosts") as cluster:
        cluster.up(hosts, tied=True)
        for host in cluster.hosts() if arguments.sysctl else []:
            cluster.on(host, "sysctl", "-qw", *arguments.sysctl, check=True)
        cluster.slurm(**dict(pair.split("=", 1) for pair in arguments.slurm))
        prepare(cluster, program, CASE)
        job = Job(cluster, launcher)
        surface = "*/checkpoint/surface.checkpoint"
        assert wait_for(lambda: list(cluster.shared.glob(surface)), 120) is not None, job.text()
        before = len(job.text())
        HARM[name](cluster, job)
        whole = [host for host in cluster.hosts() if host != "node3" or name not in LOST]
        seconds = first_times({
            "ranks": lambda: not any(ranks_of(cluster, host) for host in whole),
            "job": lambda: job.ended() is not None,
            "clean": lambda: not left_on(cluster, whole),
        }, arguments.limit)
        row = [seconds["ranks"], seconds["job"], job.ended() or "running", seconds["clean"]]
        if left := left_on(cluster, whole):
            row[-1] += f": {in_words(left)}"
        if LOST.get(name):
            LOST[name](cluster)
            row[-1] += f"; node3 {first_times({'clean': lambda: not left_on(cluster, ['node3'])}, 60)['clean']} after it is back"
        text = job.text()[before:]
        if arguments.verbose:
            print(text, file=sys.stderr)
        return [*row, f"`{words_of(text)}`"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", default="")
    parser.add_argument("--launcher", action="append", choices=LAUNCHERS)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--slurm", action="append", default=[])
    parser.add_argument("--sysctl", action="append", default=[])
    parser.add_argument("--mca", action="append", default=[])
    parser.add_argument("--verbose", action="store_true")
    add_page_option(parser)
    arguments = parser.parse_args()
    if why := obstacle():
        sys.exit(why)
    for pair in arguments.mca:
        key, value = pair.split("=", 1)
        os.environ[f"OMPI_MCA_{key}"] = value
    table = PrintedTable("Faults", ("fault", "launcher", "ranks gone after s", "job over after s", "exit code, state",
                                    "hosts clean after s", "last words"))
    for name in HARM:
        for launcher in arguments.launcher or LAUNCHERS:
            told = "B:" not in name if launcher == "srun" else launcher == "mpirun" or name == "power lost"
            if arguments.only in name and told:
                table.add(name, launcher, *measure(arguments.program, launcher, name, arguments))
    table.save(arguments.page)


if __name__ == "__main__":
    main()
