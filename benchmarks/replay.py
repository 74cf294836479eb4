#!/usr/bin/env python3
"""How well the replay of one run's records foretells the busiest of several ranks, as a Markdown table.

usage: replay.py PROGRAM CASE [RANKS ...] [-- KEY=VALUE ...]

Runs the case on each number of ranks (default 1 2 4 8) three times, in turns, and predicts the others from the record on
the first number, of its three that with the median CPU time. Compared are CPU seconds of the busiest rank (tasks, checks, all else; start
left out), summed over stages, medians; and the tasks alone. "scaled" is the prediction times all ranks' measured
CPU of tasks over that of the record's: what caches and doubled work make of it.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from volume_balance import run as report_of

REPEATS = 3


def run(program, case, ranks, settings, folder):
    report = report_of(program, case, ranks, ["output.pictures=false", *settings], folder)
    return {stage["name"]: stage for stage in report["stages"] if stage["name"] != "start"}


def busy(stage):
    return stage["cpu_seconds_max"] + stage["check_seconds"] + stage["other_seconds"]


def median_of(runs, figure):
    return statistics.median(figure(stages) for stages in runs)


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    program, case = arguments[:2]
    first, *many = [int(r) for r in arguments[2:]] or [1, 2, 4, 8]
    with tempfile.TemporaryDirectory() as name:
        top, runs = pathlib.Path(name), {ranks: [] for ranks in [first, *many]}
        for repeat in range(REPEATS):
            for ranks in runs:
                runs[ranks].append(run(program, case, ranks, settings, top / f"{ranks}_{repeat}"))
        all_of = lambda stages: sum(busy(stage) for stage in stages.values())
        order = sorted(range(REPEATS), key=lambda i: all_of(runs[first][i]))
        record = top / f"{first}_{order[REPEATS // 2]}"
        subprocess.run([program, "scaling", "--predict", record, "--ranks", ",".join(map(str, runs))], check=True,
                       capture_output=True)
        told = {row["ranks"]: {stage["name"]: stage["busy_cpu_seconds"] for stage in row["stages"]}
                for row in json.loads((record / "prediction.json").read_text())["rows"]}
    print("| ranks | stage | predicted | measured | ratio | CPU of all over the record's | scaled |\n|---|---|---|---|---|---|---|")
    total = lambda stages, ranks, name: ranks * stages[name]["cpu_seconds_mean"]
    for ranks in many:
        rows = []
        for stage in runs[first][0]:
            grown = median_of(runs[ranks], lambda s: total(s, ranks, stage)) / max(1e-9, median_of(runs[first], lambda s: total(s, first, stage)))
            rows.append((stage, told[ranks][stage], median_of(runs[ranks], lambda s: busy(s[stage])), grown))
        rows.append(("all", sum(row[1] for row in rows), median_of(runs[ranks], all_of),
                     median_of(runs[ranks], lambda s: sum(total(s, ranks, n) for n in s)) /
                     median_of(runs[first], lambda s: sum(total(s, first, n) for n in s))))
        for stage, predicted, measured, grown in rows:
            print(f"| {ranks} | {stage} | {predicted:.3f} | {measured:.3f} | {predicted / max(1e-9, measured):.2f} | {grown:.2f} "
                  f"| {predicted * grown / max(1e-9, measured):.2f} |")


if __name__ == "__main__":
    main()
