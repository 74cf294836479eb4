#!/usr/bin/env python3
"""Trailing edges of all thicknesses, all sizes from the model, as Markdown tables.

usage: edge_sweep.py PROGRAM [--shape transport|separate|tapered|partly_sharp] [--steps N] [--forecast] [--only I ...]
                     [--set KEY=VALUE ...] [--wings WINGS] [--keep FOLDER] [--page FILE]
       edge_sweep.py PROGRAM --budgets [--shape SHAPE] [--thickness SHARE ...] [--page FILE]

Thicknesses of 0.01 to 1 % of the chord in equal ratios. For each the forecast of `aeroloom check` and, without
--forecast, a run: *fate* is what `geometry.trailing_edges: auto` decided, of most edges; *aspect* what elements along
strips are longer than wide by, *forecast angle* that of such triangles (a dash where there is no strip left that is told
of); counts in thousands; *improve* its share of the CPU. With --budgets, forecasts for budgets of 1 to 20. The last lines
say what does not rise or fall as it should, where `check` and `run` decided differently, and the worst of each column
beside what it may be.
"""
import argparse
import collections
import json
import math
import os
import pathlib
import sys
import tempfile

from edges import ROOT, call, cpu_seconds
from printed_table import PrintedTable, add_page_option

PARTS = ("wing", "horizontal_tail", "vertical_tail")
SUFFIX = {"separate": "igs", "tapered": "step", "partly_sharp": "step"}
BUDGETS = (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 8.5, 10, 12, 15, 20)
NOISE = 0.03  # of a share: fields of almost the same sizes
TARGET, BUDGET = 1e6, 5  # the defaults
YARDSTICK = 0.003  # no thickness is to take longer than this one


def case_of(options, thickness, scratch):
    """A case file with trailing edges of that share of the chord."""
    case = scratch / "case.yaml"
    geometry = {"builtin": "transport", "dimensions": {part: {"trailing_edge": thickness} for part in PARTS}}
    if options.shape != "transport":
        file = scratch / f"wing.{SUFFIX[options.shape]}"
        call([options.wings, options.shape, file, f"{thickness:.9g}"])
        geometry = {"file": str(file)}
    case.write_text(json.dumps({"geometry": geometry}))
    return case


def forecast(options, case, folder, settings):
    words = [word for setting in [*settings, f"output.directory={folder}"] for word in ("--set", setting)]
    call([options.program, "check", case, *words])
    checked = json.loads((folder / "check.json").read_text())
    found = checked["forecast"]
    features = found["features"]
    aspect = features["aspect"] if features["aspect"] is not None else math.inf
    angles = [strip["surface_degrees"] for strip in features["unresolved"]]
    fates = collections.Counter(edge["fate"] for edge in found["trailing_edges"])
    return {"fate": fates.most_common(1)[0][0] if fates else "–", "aspect": aspect, "share": features["share"],
            "angle": min(angles, default=45 if aspect < 2 else 90), "predicted": found["tetrahedra"],
            "decided": decisions(found["trailing_edges"], features)}


def decisions(edges, features):
    """What `check` and `run` have to agree on."""
    return [(edge["face"], edge["fate"], edge["moved"]) for edge in edges], features["aspect"], features["share"]


def cells_of(told):
    angle = f"{told['angle']:.1f}" if told["angle"] < 45 else "–"
    return told["fate"], f"{told['aspect']:.2f}", f"{told['share']:.2f}", angle, f"{told['predicted'] / 1e3:,.0f}"


def run(options, case, folder, settings):
    words = [word for setting in [*settings, f"output.directory={folder}"] for word in ("--set", setting)]
    call([options.program, "run", case, *words])
    report = json.loads((folder / "report.json").read_text())
    stages = {stage["name"]: cpu_seconds(stage) for stage in report["stages"]}
    least, cpu = report["quality"]["min_dihedral_deg"], sum(stages.values())
    made = {"least": least, "made": report["mesh"]["tetrahedra"], "improve": stages["improve"] / cpu,
            "seconds": report["wall_seconds"], "cpu": cpu,
            "run_decided": decisions(report["sizing"]["trailing_edges"], report["sizing"]["features"])}
    cells = (f"{report['mesh']['tetrahedra'] / 1e3:,.0f}", f"{least:.1f}", f"{100 * stages['improve'] / cpu:.0f} %",
             f"{stages['sizing']:.1f}", f"{cpu:.0f}", f"{report['wall_seconds']:.0f}", report["mesh"]["hash"][:8])
    return cells, made


def thicknesses(steps):
    return [1e-4 * 100 ** (i / (steps - 1)) for i in range(steps)]


def complaint(rows, what, wrong):
    """Of neighbours in a table."""
    found = [f"{a[0]} to {b[0]}" for a, b in zip(rows, rows[1:]) if wrong(a[1], b[1])]
    return f"{what}: {'; '.join(found) if found else 'nowhere'}"


def sweep(options, scratch):
    of_runs = () if options.forecast else ("made", "least angle", "improve", "sizing, CPU s", "all, CPU s", "s", "hash")
    table = PrintedTable(f"Thicknesses, {options.shape}", (
        "trailing edge, %", "fate", "aspect", "share", "forecast angle", "predicted, thousands", *of_runs))
    rows = []
    for i, thickness in enumerate(thicknesses(options.steps)):
        if options.only and i not in options.only:
            continue
        folder = (options.keep or scratch) / f"{i}"
        case = case_of(options, thickness, scratch)
        told = forecast(options, case, folder, options.set)
        cells = (f"{100 * thickness:.3g}", *cells_of(told))
        if not options.forecast:
            of_run, made = run(options, case, folder, options.set)
            told |= made
            cells += of_run
        table.add(*cells)
        rows.append((f"{100 * thickness:.3g}", told))
    kept = [row for row in rows if row[1]["fate"] != "closed"]
    last = [complaint(kept, "shares do not fall with the thickness", lambda a, b: b["share"] > (1 + NOISE) * a["share"]),
            complaint(kept, "forecast angles do not rise with the thickness", lambda a, b: b["angle"] < a["angle"])]
    if not options.forecast:
        last += summary(rows, options)
    finish(table, last, options)


def finish(table, last, options):
    print("\n" + "\n".join(last))
    table.save(options.page, "\n".join(f"- {line}" for line in last))


def summary(rows, options):
    told = [row[1] for row in rows]
    settings = dict(setting.split("=") for setting in options.set)
    most = float(settings.get("sizing.feature_budget", BUDGET)) * float(settings.get("sizing.target_tetrahedra", TARGET))
    yardstick = min(rows, key=lambda row: abs(math.log(float(row[0]) / 100 / YARDSTICK)))
    other = [row[0] for row in rows if row[1]["decided"] != row[1]["run_decided"]]
    lines = [f"check and run decide differently: {', '.join(other) or 'nowhere'}",
             f"least angle: {min(row['least'] for row in told):.1f} (20)",
             f"tetrahedra over budget times target: {max(row['made'] for row in told) / most:.2f} (1.1)",
             f"improvement's share of the CPU: {max(row['improve'] for row in told):.2f} (0.35)"]
    for what, key in (("wall time", "seconds"), ("CPU", "cpu")):
        ratio = max(row[key] for row in told) / yardstick[1][key]
        lines.append(f"{what} over that of {yardstick[0]} %: {ratio:.2f}" + (" (1)" if key == "seconds" else ""))
    return lines


def budgets(options, scratch):
    table = PrintedTable(f"Budgets, {options.shape}", ("trailing edge, %", "budget", "fate", "aspect", "share", "forecast angle",
                                                       "predicted, thousands"))
    last = []
    for thickness in options.thickness:
        rows = []
        for budget in BUDGETS:
            case = case_of(options, thickness, scratch)
            told = forecast(options, case, scratch, [*options.set, f"sizing.feature_budget={budget}"])
            table.add(f"{100 * thickness:.3g}", f"{budget:g}", *cells_of(told))
            rows.append((f"{budget:g}", told))
        kept = [row for row in rows if row[1]["fate"] != "closed"]
        edge = f"{100 * thickness:.3g} %"
        last += [complaint(kept, f"{edge}: shares do not rise with the budget", lambda a, b: b["share"] < a["share"]),
                 complaint(kept, f"{edge}: forecast angles do not rise with the budget", lambda a, b: b["angle"] < a["angle"])]
    finish(table, last, options)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--shape", choices=["transport", *SUFFIX], default="transport")
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--only", type=int, nargs="*", help="numbers of steps, from 0")
    parser.add_argument("--forecast", action="store_true", help="no runs")
    parser.add_argument("--budgets", action="store_true")
    parser.add_argument("--thickness", type=float, nargs="*", default=[3e-4, 1e-3, 1.5e-3], help="over the chord")
    parser.add_argument("--set", nargs="*", default=[])
    parser.add_argument("--wings", default=ROOT / "build/release/benchmarks/wings")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the outputs")
    add_page_option(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        (budgets if options.budgets else sweep)(options, pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
