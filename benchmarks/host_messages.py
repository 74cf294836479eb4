#!/usr/bin/env python3
"""A recorded run's messages on hosts of one rank each with limited links, beside what the model says of them.

usage: host_messages.py MESSAGE_BENCHMARK FOLDER [--hosts 4] [--rates 1gbit 100mbit] [--repeats 3]

FOLDER is what a run on as many ranks has left (report.json, tasks.csv). The hosts are those of hosts.py. Prints the table of
message_benchmark for shared memory and for each rate.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests" / "cluster"), str(ROOT / "tests" / "pipeline")]
from cluster import SHARED, Cluster, obstacle  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--hosts", type=int, default=4)
    parser.add_argument("--rates", nargs="+", default=["1gbit", "100mbit"])
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    if why := obstacle():
        sys.exit(f"host_messages.py: {why}")
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_mpi_yield_when_idle"):
        os.environ[f"OMPI_{name}"] = "1"
    print("# shared memory\n", flush=True)
    subprocess.run([ROOT / "scripts/mpirun_local.sh", str(options.hosts), options.program, options.folder, str(options.repeats)], check=True)
    for rate in options.rates:
        print(f"\n# {rate}\n", flush=True)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_messages_"))
        with Cluster(folder / "cluster") as cluster:
            cluster.up(options.hosts, rate=rate, tied=True)
            cluster.slurm()
            shutil.copy(options.program, cluster.shared / "benchmark")
            (cluster.shared / "record").mkdir()
            for file in ("report.json", "tasks.csv"):
                shutil.copy(options.folder / file, cluster.shared / "record" / file)
            done = cluster.on("node1", "srun", "--mpi=pmix", f"--nodes={options.hosts}", f"--ntasks={options.hosts}",
                              SHARED / "benchmark", SHARED / "record", str(options.repeats), timeout=900)
        shutil.rmtree(folder)
        print(done.stdout if done.returncode == 0 else done.stdout + done.stderr, flush=True)


if __name__ == "__main__":
    main()
