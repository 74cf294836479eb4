#!/usr/bin/env python3
"""How well the replay of one run's records foretells the busiest of several ranks, as a Markdown table.

usage: replay.py PROGRAM CASE [RANKS ...] [--page FILE] [-- KEY=VALUE ...]
       replay.py PROGRAM --study FOLDER [--page FILE]

Runs the case on each number of ranks (default 1 2 4 8) three times, in turns, or takes the runs of a study (`aeroloom scaling`;
its strong series), and predicts the others from the record on the first number, of its runs that with the median CPU time.
Compared are CPU seconds of the busiest rank (tasks, checks, all else; start left out), summed over stages, medians. "scaled" is
the prediction times all ranks' measured CPU of tasks over that of the record's: what caches and doubled work make of it. Where
there are processors for all ranks, wall seconds too, on the network that the program measures between the ranks.
"""
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

from printed_table import PrintedTable, take_page_option
from volume_balance import run as report_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
REPEATS = 3


def stages_of(report):
    return {stage["name"]: stage for stage in report["stages"] if stage["name"] != "start"}


def run_all(program, case, many, settings, top):
    """Folders and stages of all runs, by the number of ranks."""
    runs = {ranks: [] for ranks in many}
    for repeat in range(REPEATS):
        for ranks in many:
            folder = top / f"{ranks}_{repeat}"
            runs[ranks].append((folder, stages_of(report_of(program, case, ranks, ["output.pictures=false", *settings], folder))))
    return runs


def runs_of_study(folder):
    runs = {}
    for report in sorted(pathlib.Path(folder).glob("runs/strong_*/report.json")):
        text = json.loads(report.read_text())
        if text["status"] == "ok":
            runs.setdefault(text["ranks"], []).append((report.parent, stages_of(text)))
    return dict(sorted(runs.items()))


def busy(stage):
    return stage["cpu_seconds_max"] + stage["check_seconds"] + stage["other_seconds"]


def busy_of_all(stages):
    return sum(busy(stage) for stage in stages.values())


def median_of(runs, figure):
    return statistics.median(figure(stages) for folder, stages in runs)


def predictions(program, record, many, options=()):
    """Of a copy of the record: its folder may be a study's."""
    with tempfile.TemporaryDirectory() as name:
        for file in ("report.json", "tasks.csv"):
            shutil.copy(record / file, name)
        subprocess.run([program, "scaling", "--predict", name, "--ranks", ",".join(map(str, many)), *options], check=True, capture_output=True)
        rows = json.loads((pathlib.Path(name) / "prediction.json").read_text())["rows"]
    return {row["ranks"]: {stage["name"]: stage for stage in row["stages"]} for row in rows}


def tabulate_busy(runs, first, told, page):
    table = PrintedTable("Work of the busiest rank", ("ranks", "stage", "predicted", "measured", "ratio", "CPU of all over the record's",
                                                      "scaled"))
    total = lambda stages, ranks, names: ranks * sum(stages[name]["cpu_seconds_mean"] for name in names)
    grown = lambda ranks, names: (median_of(runs[ranks], lambda s: total(s, ranks, names)) /
                                  max(1e-9, median_of(runs[first], lambda s: total(s, first, names))))
    names = list(runs[first][0][1])
    for ranks in list(runs)[1:]:
        rows = [(name, told[ranks][name]["busy_cpu_seconds"], median_of(runs[ranks], lambda s: busy(s[name])), grown(ranks, [name]))
                for name in names]
        rows.append(("all", sum(row[1] for row in rows), median_of(runs[ranks], busy_of_all), grown(ranks, names)))
        for name, predicted, measured, factor in rows:
            table.add(ranks, name, f"{predicted:.3f}", f"{measured:.3f}", f"{predicted / max(1e-9, measured):.2f}", f"{factor:.2f}",
                      f"{predicted * factor / max(1e-9, measured):.2f}")
    table.save(page)


def tabulate_wall(program, runs, record, page):
    """On the processors that there are."""
    many = [ranks for ranks in list(runs)[1:] if ranks <= os.cpu_count()]
    if not many:
        return
    print()
    table = PrintedTable("Wall seconds", ("ranks", "predicted", "measured", "ratio"))
    for ranks in many:
        with tempfile.TemporaryDirectory() as name:
            network = pathlib.Path(name) / "network.json"
            subprocess.run([ROOT / "scripts/mpirun_local.sh", str(ranks), program, "scaling", "--measure-network", network], check=True,
                           capture_output=True)
            told = predictions(program, record, [ranks], ["--network", network])[ranks]
        predicted = sum(stage["seconds"] for name, stage in told.items() if name != "start")
        measured = median_of(runs[ranks], lambda s: sum(stage["wall_seconds"] for stage in s.values()))
        table.add(ranks, f"{predicted:.2f}", f"{measured:.2f}", f"{predicted / measured:.2f}")
    table.save(page)


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    arguments, page = take_page_option(arguments)
    program = arguments[0]
    with tempfile.TemporaryDirectory() as name:
        if arguments[1] == "--study":
            runs = runs_of_study(arguments[2])
        else:
            runs = run_all(program, arguments[1], [int(r) for r in arguments[2:]] or [1, 2, 4, 8], settings, pathlib.Path(name))
        first = next(iter(runs))
        record = sorted(runs[first], key=lambda run: busy_of_all(run[1]))[len(runs[first]) // 2][0]
        tabulate_busy(runs, first, predictions(program, record, runs), page)
        tabulate_wall(program, runs, record, page)


if __name__ == "__main__":
    main()
