#!/usr/bin/env python3
"""A small cluster on one machine: hosts with a name, processes, links, /tmp, /dev/shm and /run of their own, on one switch.

usage: cluster.py FOLDER up HOSTS [--rate 1gbit]     node1 to nodeN; FOLDER is made, and is what tells clusters apart
       cluster.py FOLDER on HOST COMMAND...          runs a command there, in the host's /tmp
       cluster.py FOLDER slurm [KEY=VALUE...]        starts SLURM, node1 controls; with these keys of slurm.conf
       cluster.py FOLDER freeze|thaw HOST            a host whose processes stand still, and go on
       cluster.py FOLDER cut|join HOST               a link that is down, and up again
       cluster.py FOLDER kill HOST                   a host without power: nobody is told, it does not come back
       cluster.py FOLDER counters                    bytes that each host has received and sent
       cluster.py FOLDER down                        ends all that there is, also what a failed `up` has left

Hosts share FOLDER/shared as /mnt, and read the machine's files; whatever else they write is their own. Links are limited to
the rate both ways, without latency. All addresses are inside. Needs root, iproute2 and util-linux; for SLURM slurm-wlm
and munge, whose folders in /etc are replaced within hosts only. Without a kernel that lets hosts be made, `unshare -mn true` fails.
"""
import argparse
import json
import os
import pathlib
import secrets
import shutil
import signal
import subprocess
import sys
import time

HOST = pathlib.Path(__file__).resolve().with_name("host.sh")
SWITCH = "switch"
SHARED = pathlib.Path("/mnt")  # where hosts see FOLDER/shared
NAMESPACES = ["--mount", "--uts", "--ipc", "--net", "--pid"]
PROGRAMS = {"ip": "iproute2", "unshare": "util-linux", "slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "munged": "munge"}

os.environ["PATH"] += ":/usr/sbin:/sbin"  # where daemons are, which users need not have in theirs

SLURM_DEFAULTS = {
    "ClusterName": "small", "SlurmctldHost": "node1", "SlurmUser": "root", "AuthType": "auth/munge",
    "StateSaveLocation": "/run/slurmctld", "SlurmctldPidFile": "/run/slurmctld.pid", "SlurmctldLogFile": "/run/slurmctld.log",
    "SlurmdSpoolDir": "/run/slurmd", "SlurmdPidFile": "/run/slurmd.pid", "SlurmdLogFile": "/run/slurmd.log",
    "ProctrackType": "proctrack/linuxproc", "TaskPlugin": "task/none", "JobAcctGatherType": "jobacct_gather/none",
    "SelectType": "select/cons_tres", "SelectTypeParameters": "CR_CPU", "SlurmdParameters": "config_overrides",
    "ReturnToService": 2,
}


def obstacle():
    """What keeps this machine from holding a cluster with SLURM, in words, or None."""
    done = subprocess.run(["unshare", "-mn", "true"], capture_output=True, text=True)
    if done.returncode != 0:
        return "`unshare -mn true` fails: " + done.stderr.strip()
    missing = sorted({package for name, package in PROGRAMS.items() if shutil.which(name) is None})
    return f"packages are missing: {', '.join(missing)} (scripts/setup.sh --cluster)" if missing else None


def sh(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


class Cluster:
    """With a `with` statement it goes down at the end; tied, also with the process that made it, however that ends."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        self.shared = self.folder / "shared"
        self._first = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.down()

    # Processes tell what there is: no list that could be out of date.
    def _first_processes(self):
        """The first process of each host, by name, as the machine numbers them."""
        found = {}
        for entry in pathlib.Path("/proc").iterdir():
            try:
                words = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0") if entry.name.isdigit() else []
            except OSError:
                continue
            if words[1:3] == [str(HOST), str(self.folder)]:
                found[words[3]] = int(entry.name)
        return found

    def hosts(self):
        return sorted((name for name in self._first_processes() if name != SWITCH), key=lambda name: int(name[4:]))

    def processes(self, host):
        """All processes of a host but its first: command lines, by the machine's number."""
        first, found = self._first_processes()[host], {}
        space = os.readlink(f"/proc/{first}/ns/pid")
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and int(entry.name) != first and os.readlink(entry / "ns" / "pid") == space:
                    words = (entry / "cmdline").read_bytes().decode(errors="replace").replace("\0", " ").strip()
                    found[int(entry.name)] = words or "(ended)"
            except OSError:
                continue
        return {number: words for number, words in found.items() if words != "sleep infinity"}

    def up(self, hosts, rate="1gbit", tied=False):
        names = [f"node{i}" for i in range(1, hosts + 1)]
        addresses = {name: f"10.77.0.{i}" for i, name in enumerate(names, 1)}
        for place in ("etc/slurm", "etc/munge", "shared"):
            (self.folder / place).mkdir(parents=True)
        lines = ["127.0.0.1 localhost"] + [f"{address} {name}" for name, address in addresses.items()]
        (self.folder / "etc" / "hosts").write_text("\n".join(lines) + "\n")
        try:
            first = {name: self._start(name, tied) for name in [SWITCH, *names]}
            switch = ["nsenter", "-t", first[SWITCH], "--net", "ip"]
            sh(*switch, "link", "add", "bridge0", "type", "bridge")
            sh(*switch, "link", "set", "bridge0", "up")
            for name in names:
                sh(*switch, "link", "add", "dev", name, "type", "veth", "peer", "name", "eth0", "netns", first[name])
                sh(*switch, "link", "set", name, "master", "bridge0", "up")
                inside = ["nsenter", "-t", first[name], "--net", "ip"]
                sh(*inside, "address", "add", addresses[name] + "/24", "dev", "eth0")
                sh(*inside, "link", "set", "eth0", "up")
                sh(*inside, "link", "set", "lo", "up")
                if rate != "none":
                    for process, device in ((first[name], "eth0"), (first[SWITCH], name)):
                        sh("nsenter", "-t", process, "--net", "tc", "qdisc", "add", "dev", device, "root", "tbf", "rate", rate,
                           "burst", "256kb", "latency", "50ms")
        except BaseException:
            self.down()
            raise

    def _start(self, name, tied):
        """The number of a new host's first process, once that has all its mounts."""
        words = ["setpriv", "--pdeathsig", "KILL"] if tied else []
        words += ["unshare", *NAMESPACES, "--fork", "--kill-child", "--mount-proc", "bash", str(HOST), str(self.folder), name]
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   start_new_session=True)
        self._first.append(process)
        with process.stdout as said:
            line = said.readline()
            if line != "ready\n":
                raise RuntimeError(f"{name}: {line}{said.read()}")
        return self._first_processes()[name]

    def command(self, host, *words):
        """The command line that runs another on a host."""
        process = self._first_processes().get(host)
        if process is None:
            raise RuntimeError(f"there is no {host}")
        return ["nsenter", "-t", str(process), *NAMESPACES, "--wdns=/tmp", *map(str, words)]

    def on(self, host, *words, **options):
        return subprocess.run(self.command(host, *words), **{"capture_output": True, "text": True, **options})

    def start(self, host, *words, **options):
        return subprocess.Popen(self.command(host, *words), **options)

    def _signal(self, host, number):
        """To all processes of a host, those that start meanwhile included."""
        reached = set()
        while more := set(self.processes(host)) - reached:
            for process in more:
                try:
                    os.kill(process, number)
                except ProcessLookupError:
                    pass
            reached |= more

    def freeze(self, host):
        self._signal(host, signal.SIGSTOP)

    def thaw(self, host):
        self._signal(host, signal.SIGCONT)

    def _link(self, host, state):
        sh("nsenter", "-t", self._first_processes()[SWITCH], "--net", "ip", "link", "set", host, state)

    def cut(self, host):
        self._link(host, "down")

    def join(self, host):
        self._link(host, "up")

    def kill(self, host):
        self.cut(host)
        os.kill(self._first_processes()[host], signal.SIGKILL)

    def counters(self):
        """Bytes received and sent, by host."""
        found = {}
        for name in self.hosts():
            link = json.loads(self.on(name, "ip", "-s", "-j", "link", "show", "eth0").stdout)[0]
            found[name] = (link["stats64"]["rx"]["bytes"], link["stats64"]["tx"]["bytes"])
        return found

    def slurm(self, processors=4, seconds=30, **keys):
        """Starts SLURM on all hosts and waits until it would start jobs on them."""
        names = self.hosts()
        nodes = f"NodeName=node[1-{len(names)}] CPUs={processors} RealMemory=1000 State=UNKNOWN"
        lines = [f"{key}={value}" for key, value in {**SLURM_DEFAULTS, **keys}.items()]
        lines += [nodes, "PartitionName=all Nodes=ALL Default=YES State=UP"]
        settings = self.folder / "etc" / "slurm"
        (settings / "slurm.conf").write_text("\n".join(lines) + "\n")
        # Named, for hosts have no control groups of their own to find out the kind from. Nothing uses them.
        (settings / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        key = self.folder / "etc" / "munge" / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o400)
        for name in names:
            sh(*self.command(name, "mkdir", "-p", "/run/munge", "/run/slurmd", "/run/slurmctld"))
            sh(*self.command(name, "munged", "--log-file=/run/munge/log", "--seed-file=/run/munge/seed"))
        sh(*self.command("node1", "slurmctld"))
        for name in names:
            sh(*self.command(name, "slurmd"))
        end = time.monotonic() + seconds
        while (states := self.on("node1", "sinfo", "--noheader", "--Node", "--format=%T").stdout.split()) != ["idle"] * len(names):
            if time.monotonic() > end:
                raise RuntimeError(f"SLURM's nodes are {' '.join(states) or 'not known'} after {seconds} seconds")
            time.sleep(0.1)

    def down(self):
        while left := self._first_processes():
            for process in left.values():
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            time.sleep(0.05)
        for process in self._first:
            process.wait()
        if (self.folder / "etc" / "hosts").exists():
            shutil.rmtree(self.folder)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder")
    parser.add_argument("what", choices=["up", "on", "slurm", "freeze", "thaw", "cut", "join", "kill", "counters", "down"])
    parser.add_argument("words", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    cluster, words = Cluster(arguments.folder), arguments.words
    if arguments.what == "up":
        options = argparse.ArgumentParser(usage=__doc__)
        options.add_argument("hosts", type=int)
        options.add_argument("--rate", default="1gbit")
        cluster.up(**vars(options.parse_args(words)))
    elif arguments.what == "on":
        sys.exit(subprocess.run(cluster.command(*words)).returncode)
    elif arguments.what == "slurm":
        cluster.slurm(**dict(word.split("=", 1) for word in words))
    elif arguments.what == "counters":
        for name, (received, sent) in cluster.counters().items():
            print(f"{name} received {received} sent {sent}")
    else:
        getattr(cluster, arguments.what)(*words)


if __name__ == "__main__":
    main()
