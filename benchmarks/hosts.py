#!/usr/bin/env python3
"""A run on hosts of one rank each with limited links, beside the same run on one host through shared memory, as Markdown tables:
seconds and bytes of each stage, and the bytes that the program counted beside those that the links counted.

usage: hosts.py PROGRAM CASE [--hosts 4] [--rate 1gbit] [--repeats 3] [--page FILE]

The hosts are made on this machine (tests/cluster/cluster.py: root, slurm-wlm, munge), so they share its processors: seconds say
what links cost, not what more processors bring. Of each kind the run with the median of the seconds is shown. Links are read a
hundred times a second. When the first stage began is not written anywhere: of the moments within half a second the one that
fits best is taken, one for all stages, so bytes of single stages are good to some hundredths of a second of a full link; those
of the sum are exact. A case names its file by the whole path, which is not in /tmp. The least that a link carries besides,
starting and ending the processes, is in the sum.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests" / "cluster"), str(ROOT / "tests" / "pipeline")]
from cluster import SHARED, Cluster, obstacle  # noqa: E402
from printed_table import PrintedTable, add_page_option  # noqa: E402

PLAIN = ["--set", "output.pictures=false"]


def report_of(folder):
    return json.loads((folder / "report.json").read_text())


def run_here(options, folder):
    command = [ROOT / "scripts/mpirun_local.sh", options.hosts, options.program, "run", options.case, *PLAIN,
               "--set", f"output.directory={folder}"]
    subprocess.run([str(word) for word in command], check=True, capture_output=True, cwd=ROOT)
    return report_of(folder)


class Reader(threading.Thread):
    """Bytes sent by all hosts, with the time."""

    def __init__(self, cluster):
        super().__init__(daemon=True)
        first = cluster._first_processes()
        self.files = [pathlib.Path(f"/proc/{number}/net/dev") for name, number in first.items() if name != "switch"]
        self.samples, self.over = [], False

    def sent(self):
        lines = [next(line for line in file.read_text().splitlines() if "eth0:" in line) for file in self.files]
        return sum(int(line.split(":")[1].split()[8]) for line in lines)

    def run(self):
        while not self.over:
            self.samples.append((time.monotonic(), self.sent()))
            time.sleep(0.01)

    def at(self, when):
        return next((sent for moment, sent in self.samples if moment >= when), self.samples[-1][1])


def run_on_hosts(options, cluster):
    """The report, and the bytes that links carried: of each stage about, and of all."""
    out = cluster.shared / "out"
    shutil.rmtree(out, ignore_errors=True)
    reader = Reader(cluster)
    reader.start()
    words = ["srun", "--mpi=pmix", f"--nodes={options.hosts}", f"--ntasks={options.hosts}", SHARED / "aeroloom", "run",
             SHARED / "case.yaml", *PLAIN, "--set", f"output.directory={SHARED}/out"]
    done = cluster.on("node1", *words, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    reader.over = True
    reader.join()
    report = report_of(out)
    # The report is written when the last stage is over.
    end = time.monotonic() - (time.time() - (out / "report.json").stat().st_mtime)
    total = sum(stage["wall_seconds"] for stage in report["stages"])
    fits = []
    for shift in range(-50, 51):
        moment, carried = end - total + shift / 100, []
        for stage in report["stages"]:
            carried.append(reader.at(moment + stage["wall_seconds"]) - reader.at(moment))
            moment += stage["wall_seconds"]
        fits.append((sum((bytes_ - counted(stage)) ** 2 for bytes_, stage in zip(carried, report["stages"])), carried))
    return report, min(fits)[1], reader.samples[-1][1] - reader.samples[0][1]


def counted(stage):
    return sum(kind["bytes"] for kind in stage["messages"].values())


def median(runs, report):
    return sorted(runs, key=lambda run: sum(s["wall_seconds"] for s in report(run)["stages"]))[len(runs) // 2]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("case", type=os.path.abspath)
    parser.add_argument("--hosts", type=int, default=4)
    parser.add_argument("--rate", default="1gbit")
    parser.add_argument("--repeats", type=int, default=3)
    add_page_option(parser)
    options = parser.parse_args()
    if why := obstacle():
        sys.exit(f"hosts.py: {why}")
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_mpi_yield_when_idle"):
        os.environ[f"OMPI_{name}"] = "1"
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_hosts_"))
    with Cluster(folder / "cluster") as cluster:
        cluster.up(options.hosts, rate=options.rate, tied=True)
        cluster.slurm()
        shutil.copy(options.program, cluster.shared / "aeroloom")
        shutil.copy(options.case, cluster.shared / "case.yaml")
        here, there = [], []
        for _ in range(options.repeats):
            here.append(run_here(options, folder / "here"))
            there.append(run_on_hosts(options, cluster))
    shutil.rmtree(folder)
    memory = median(here, lambda run: run)
    links, carried, total = median(there, lambda run: run[0])
    assert memory["mesh"]["hash"] == links["mesh"]["hash"]
    mesh = links["mesh"]
    note = f"{mesh['tetrahedra']:,} tetrahedra, {options.hosts} ranks, {options.rate}, hash {mesh['hash'][:8]}"
    print(f"{note}\n")
    table = PrintedTable("Stages", ("stage", "shared memory, s", "links, s", "MB counted", "MB of the links"))
    for one, other, bytes_ in zip(memory["stages"], links["stages"], carried):
        table.add(one["name"], f"{one['wall_seconds']:.2f}", f"{other['wall_seconds']:.2f}", f"{counted(other) / 1e6:.1f}",
                  f"{bytes_ / 1e6:.1f}")
    seconds = [sum(s["wall_seconds"] for s in report["stages"]) for report in (memory, links)]
    table.add("all", f"{seconds[0]:.2f}", f"{seconds[1]:.2f}", f"{sum(map(counted, links['stages'])) / 1e6:.1f}", f"{total / 1e6:.1f}")
    table.save(options.page, note)


if __name__ == "__main__":
    main()
