"""A folder to work in on the command line, for the end-to-end tests."""
import os
import pathlib
import shlex
import subprocess
import tempfile

from program import SOURCE, with_fault

LAUNCHER = str(SOURCE / "scripts" / "mpirun_local.sh")


class Shell:
    """A folder to work in, with the program called `aeroloom`."""

    def __init__(self, program):
        self.program = str(pathlib.Path(program).resolve())
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_line_"))

    def run(self, line, ranks=1, fault=None):
        """Exit code, standard output and standard error of `aeroloom LINE`."""
        command = [LAUNCHER, str(ranks), self.program] + shlex.split(line)
        done = subprocess.run(command, capture_output=True, text=True, timeout=200, cwd=self.folder,
                              env=with_fault(fault))
        return done.returncode, done.stdout, done.stderr

    def type(self, line):
        """As a shell would run the line."""
        bin_folder = self.folder / "bin"
        bin_folder.mkdir(exist_ok=True)
        real = os.environ["PATH"]
        # mpirun_local.sh must not find itself under the name mpirun; options before the number of ranks are its own.
        for name, body in (("aeroloom", f'exec "{LAUNCHER}" 1 "{self.program}" "$@"'),
                           ("mpirun", f'PATH="{real}"; export PATH\nwhile [ "$1" != -n ]; do shift; done\n'
                                      f'ranks=$2; shift 3; exec "{LAUNCHER}" "$ranks" "{self.program}" "$@"')):
            (bin_folder / name).write_text(f"#!/bin/sh\n{body}\n")
            (bin_folder / name).chmod(0o755)
        return subprocess.run(["bash", "-c", line], capture_output=True, text=True, timeout=300, cwd=self.folder,
                              env={**os.environ, "PATH": f"{bin_folder}:{real}"})
