#!/usr/bin/env python3
"""Seconds per stage of whole runs from CAD to the written mesh over the size of the mesh, as a Markdown table and a plot.

usage: stage_times.py [PROGRAM] [SIZE ...] [--ranks N ...] [--repeats N] [--report FILE ...] [--table FILE] [--plot FILE]
           [--page FILE]

Sizes are numbers of tetrahedra (1e5 1e6 ...) around the built-in aircraft, all other sizes from the model. Each run is
reported by its report.json; of the repeats the one with the median wall time counts, and its mesh is deleted. --report
takes reports of runs that were made otherwise. All are put into the table (CSV), which keeps what it has of other sizes
and ranks; page and plot are made of the table. Without a program nothing is run.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import subprocess
import tempfile

from plots import Panel, save
from printed_table import PrintedTable, add_page_option
from surface_runs import RESULTS, ROOT

FIELDS = ["size", "ranks", "tetrahedra", "stage", "wall_seconds", "busiest_cpu_seconds", "waiting_seconds_mean"]
TOTAL = "whole run"


def run(program, size, ranks, folder):
    case = folder / "case.yaml"
    case.write_text(f"geometry: {{builtin: transport}}\nsizing: {{target_tetrahedra: {float(size):.0f}}}\n"
                    f"output: {{directory: {folder / 'out'}, pictures: false}}\n")
    subprocess.run([str(c) for c in (ROOT / "scripts/mpirun_local.sh", ranks, program, "run", case)], check=True,
                   capture_output=True)
    return json.loads((folder / "out" / "report.json").read_text())


def rows_of(report):
    """Sizes are named by the nearest half power of ten, so that a table holds one run of each."""
    tetrahedra = report["mesh"]["tetrahedra"]
    common = [f"{10 ** (round(2 * math.log10(tetrahedra)) / 2):.3g}", report["ranks"], tetrahedra]
    rows = [common + [s["name"], s["wall_seconds"], s["cpu_seconds_max"] + s["check_seconds"] + s["other_seconds"],
                      s["waiting_seconds_mean"]] for s in report["stages"]]
    columns = zip(*(row[5:] for row in rows))
    rows.append(common + [TOTAL, report["wall_seconds"], *map(sum, columns)])
    return [dict(zip(FIELDS, row)) for row in rows]


def merge(table, fresh):
    known = list(csv.DictReader(table.open())) if table.exists() else []
    key = lambda row: (float(row["size"]), int(row["ranks"]))
    replaced = set(map(key, fresh))
    rows = sorted([row for row in known if key(row) not in replaced] + fresh, key=key)
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: f"{v:.4g}" if isinstance(v, float) else v for name, v in row.items()} for row in rows)
    return list(csv.DictReader(table.open()))


def tabulate(rows, page):
    stages = list(dict.fromkeys(row["stage"] for row in rows if row["stage"] != TOTAL)) + [TOTAL]
    table = PrintedTable("Seconds by stage", ("tetrahedra", "ranks", *stages, "µs per tetrahedron"))
    runs = list(dict.fromkeys((row["tetrahedra"], row["ranks"]) for row in rows))
    for tetrahedra, ranks in runs:
        seconds = {row["stage"]: float(row["wall_seconds"]) for row in rows
                   if (row["tetrahedra"], row["ranks"]) == (tetrahedra, ranks)}
        table.add(f"{int(tetrahedra):,}", ranks, *(f"{seconds[s]:.3g}" if s in seconds else "–" for s in stages),
                  f"{1e6 * seconds[TOTAL] / int(tetrahedra):.1f}")
    table.save(page)
    return stages


def draw(path, rows, stages):
    panels = []
    for ranks in sorted({int(row["ranks"]) for row in rows}):
        mine = [row for row in rows if int(row["ranks"]) == ranks]
        panel = Panel(f"{ranks} rank{'s' if ranks > 1 else ''}", "tetrahedra", "wall seconds", x_log=10, y_log=10, height=360)
        for kind, stage in enumerate(stages):
            of = [row for row in mine if row["stage"] == stage]
            panel.line(stage, [int(row["tetrahedra"]) for row in of], [float(row["wall_seconds"]) for row in of], kind)
        panels.append(panel)
    low, high = (f(float(row["wall_seconds"]) for row in rows if float(row["wall_seconds"]) > 0) for f in (min, max))
    for panel in panels:
        panel.y.low, panel.y.high, panel.y.fixed = 10 ** math.floor(math.log10(low)), 10 ** math.ceil(math.log10(high)), (1, 1)
    save(path, panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=os.path.abspath)
    parser.add_argument("sizes", nargs="*", default=[])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--report", type=pathlib.Path, nargs="+", default=[])
    parser.add_argument("--table", type=pathlib.Path, default=RESULTS / "stage_times.csv")
    parser.add_argument("--plot", default=RESULTS / "stage_times.svg")
    add_page_option(parser)
    options = parser.parse_args()
    rows = [row for path in options.report for row in rows_of(json.loads(path.read_text()))]
    for size in options.sizes:
        reports = {ranks: [] for ranks in options.ranks}
        for _ in range(options.repeats):
            for ranks, of in reports.items():
                with tempfile.TemporaryDirectory() as folder:
                    of.append(run(options.program, size, ranks, pathlib.Path(folder)))
        for of in reports.values():
            rows += rows_of(sorted(of, key=lambda report: report["wall_seconds"])[len(of) // 2])
        merge(options.table, rows)
    rows = merge(options.table, rows)
    draw(options.plot, rows, tabulate(rows, options.page))


if __name__ == "__main__":
    main()
