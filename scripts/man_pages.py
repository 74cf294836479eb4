#!/usr/bin/env python3
"""Writes the man pages of the program, made of its --help and that of each command, compressed.
usage: man_pages.py PROGRAM FOLDER"""
import gzip
import pathlib
import re
import subprocess
import sys

SECTION = re.compile(r"^([A-Z][\w ]*):$")
ENTRY = re.compile(r"^ {2,4}(\S.*?)(?: {2,}(\S.*))?$")
DEEPER = re.compile(r"^ {6,}(\S.*)$")


def escaped(text):
    """Text that roff prints as it stands."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return r"\&" + text if text[:1] in {".", "'"} else text


def bold(text):
    return r"\fB" + escaped(text) + r"\fR"


def said_by(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def parts(text):
    """What a help text says: its summary, its usage, and its sections as {title: [(term, description)]}."""
    summary, usage, sections = [], "", {}
    for line in text.splitlines():
        if line.startswith("Usage: "):
            usage = line.removeprefix("Usage: ")
        elif SECTION.match(line):
            entries = sections.setdefault(SECTION.match(line).group(1), [])
        elif not line.strip():
            continue
        elif not usage:
            summary.append(line)
        elif DEEPER.match(line) and entries:
            term, description = entries[-1]
            entries[-1] = term, f"{description} {DEEPER.match(line).group(1)}".strip()
        elif ENTRY.match(line) and sections:
            entries.append((ENTRY.match(line).group(1), ENTRY.match(line).group(2) or ""))
        else:
            raise SystemExit(f"man_pages: not a line of a help text: '{line}'")
    return summary, usage, sections


def page(name, version, text, others):
    """The man page of a help text, as roff."""
    summary, usage, sections = parts(text)
    purpose = summary[0].removeprefix("Aeroloom: ").rstrip(".")
    dashed = name.replace(" ", "-")
    lines = [f'.TH {dashed.upper()} 1 "" "aeroloom {version}" "User Commands"', ".SH NAME",
             escaped(dashed) + r" \- " + escaped(purpose), ".SH SYNOPSIS", bold(name) + escaped(usage.removeprefix(name))]
    if summary[1:]:
        lines += [".SH DESCRIPTION", *map(escaped, summary[1:])]
    for title, entries in sections.items():
        lines.append(f".SH {title.upper()}")
        for term, description in entries:
            lines += [".TP", bold(term), escaped(description) or r"\&"]
    lines += [".SH SEE ALSO", ",\n".join(f"{bold(other)}(1)" for other in others) + ".", ".PP",
              "What is named docs/ here lies in share/doc/aeroloom/docs of an installation."]
    return "\n".join(lines) + "\n"


def write(path, text):
    # Without name and time: the same pages make the same bytes.
    path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.1.gz"):
        old.unlink()
    version = said_by(program, "--version").split()[1]
    whole = said_by(program, "--help")
    commands = [term for term, _ in parts(whole)[2]["Commands"]]
    write(folder / "aeroloom.1.gz", page("aeroloom", version, whole, [f"aeroloom-{c}" for c in commands] + ["mpirun"]))
    for command in commands:
        text = said_by(program, command, "--help")
        write(folder / f"aeroloom-{command}.1.gz", page(f"aeroloom {command}", version, text, ["aeroloom"]))


if __name__ == "__main__":
    main()
