#!/usr/bin/env python3
"""What `aeroloom check` forecasts of cases against their runs on one rank, as a Markdown table.

usage: forecasts.py PROGRAM CASE ... [--page FILE] [-- KEY=VALUE ...]

Ratios are forecast over run: triangles, tetrahedra, memory (the most that the program and its children occupied in any stage), and
seconds of CPU, which on one rank are those of the clock; pictures left out. The last row counts the cases whose tetrahedra are within
15 %, memory within 25 %, time within 40 %.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

from printed_table import PrintedTable, add_page_option

BARS = {"tetrahedra": 1.15, "memory": 1.25, "time": 1.4}


def call(program, command, case, folder, settings):
    arguments = [program, command, case, "-q"]
    for setting in (f"output.directory={folder}", "output.pictures=false", *settings):
        arguments += ["--set", setting]
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)


def cpu_seconds():
    """Of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def ratios(program, case, settings):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        call(program, "check", case, folder, settings)
        forecast = json.loads((folder / "check.json").read_text())["forecast"]
        before = cpu_seconds()
        call(program, "run", case, folder, settings)
        seconds = cpu_seconds() - before
        report = json.loads((folder / "report.json").read_text())
    memory = max(stage["peak_rss_bytes_sum"] for stage in report["stages"])
    return report["mesh"]["tetrahedra"], {
        "triangles": forecast["triangles"] / report["mesh"]["boundary_triangles"],
        "tetrahedra": forecast["tetrahedra"] / report["mesh"]["tetrahedra"],
        "memory": forecast["bytes"] / memory,
        "time": forecast["seconds_on_one_core"] / seconds,
    }


def main():
    words = sys.argv[1:]
    at = words.index("--") if "--" in words else len(words)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("cases", nargs="+")
    add_page_option(parser)
    arguments = parser.parse_args(words[:at])
    table = PrintedTable("Forecast over run", ("case", "tetrahedra of the run", "triangles", "tetrahedra", "memory", "time"))
    within = dict.fromkeys(BARS, 0)
    for case in arguments.cases:
        count, found = ratios(arguments.program, case, words[at + 1:])
        for name, bar in BARS.items():
            within[name] += 1 / bar <= found[name] <= bar
        table.add(pathlib.Path(case).stem, f"{count:,}", *(f"{ratio:.2f}" for ratio in found.values()))
    table.add("all", "", "", *(f"{within[name]} of {len(arguments.cases)} within {BARS[name] - 1:.0%}" for name in BARS))
    table.save(arguments.page)


if __name__ == "__main__":
    main()
