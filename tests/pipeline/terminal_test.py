#!/usr/bin/env python3
"""What the program shows on a terminal, and what not in a file. usage: terminal_test.py PROGRAM"""
import os
import pty
import re
import sys

from program import COARSE_DUCT, COARSE_WING, NO_PICTURES
from shell import Shell


def on_terminal(shell, line, **environment):
    """What the program writes to a terminal."""
    written = b""

    def read(descriptor):
        nonlocal written
        data = os.read(descriptor, 65536)
        written += data
        return data

    command = ["env", "-u", "NO_COLOR", "TERM=xterm", *(f"{name}={value}" for name, value in environment.items()),
               "sh", "-c", f'cd "{shell.folder}" && exec "{shell.program}" {line}']
    silent = os.open(os.devnull, os.O_WRONLY)
    screen = os.dup(1)
    os.dup2(silent, 1)
    try:
        pty.spawn(command, read)
    finally:
        os.dup2(screen, 1)
    return written.decode().replace("\r\n", "\n")


def check_progress(shell):
    """On a terminal one line that leaves nothing behind; plain lines, here too few to show, where that is asked for."""
    erase = "\r\x1b[K"
    text = on_terminal(shell, "run slow.yaml --set output.directory=slow")  # long enough to show progress
    assert re.search(re.escape(erase) + r"(sizing|surface|volume|improve) +\d+ %  \d+ [a-z ]+  \d+ MB  \d+\.\d s", text), text
    left = [line.split(erase)[-1] for line in text.split("\n")]
    assert not any(re.search(r" \d+ MB  ", line) for line in left), left
    facts = [line for line in shell.run("run slow.yaml --set output.directory=slow")[1].split("\n") if re.match("(geometry|sizing|surface|hash):", line)]
    assert [line for line in facts if "MB" not in line and line not in left] == [], left
    for how in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        assert "\x1b" not in on_terminal(shell, "run quick.yaml --set output.directory=quick", **how)
    assert erase not in on_terminal(shell, "-q run quick.yaml --set output.directory=quick")


def main():
    shell = Shell(sys.argv[1])
    (shell.folder / "quick.yaml").write_text(COARSE_DUCT + NO_PICTURES)
    slow = COARSE_WING.replace("minimum: 0.5", "minimum: 0.06").replace("surface_maximum: 2", "surface_maximum: 0.08")
    (shell.folder / "slow.yaml").write_text(slow + NO_PICTURES)
    check_progress(shell)


if __name__ == "__main__":
    main()
