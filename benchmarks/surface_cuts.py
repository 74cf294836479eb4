#!/usr/bin/env python3
"""What each step of the decomposition of CAD faces is worth: a Markdown table and a plot of models meshed without it.

usage: surface_cuts.py SURFACE_BENCHMARK [FILE ...] [--piece-triangles N] [--plot FILE] [--page FILE]

The steps are the simplification of the dual graph (contraction of arcs), the repair of parts that METIS leaves asunder,
the widening of wedges that are still sharp, and the straightening of cuts. Angles are those between fine edges where
cuts end: on feature curves and where cuts meet.
"""
import argparse
import os
import pathlib
import tempfile

from plots import Panel, save
from printed_table import PrintedTable, add_page_option
from surface_runs import FILES, RESULTS, run_with_details, write_case

VARIANTS = {  # the steps that are left out
    "METIS alone": "contraction,repair,widening,straightening",
    "simplified graph alone": "repair,widening,straightening",
    "not simplified": "contraction",
    "not repaired": "repair",
    "not widened": "widening",
    "not straightened": "straightening",
    "all steps": "",
}
BINS = (0, 20, 30, 40, 50, 360)


def row(model, name, r, details):
    angles = details["cut_angles"]
    bins = [sum(low <= a < high for a in angles) for low, high in zip(BINS, BINS[1:])]
    return (model, name, r["pieces"], *bins, r["cut_angle_min"], r["cut_edges"], r["imbalance"], r["rounds"], r["cut_min_angle"],
            r["cut_worst"], f"{r['cut_mean_ratio']} / {r['other_mean_ratio']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("files", nargs="*", type=pathlib.Path, default=[file for file in FILES if file.exists()])
    parser.add_argument("--piece-triangles", type=int, default=1500)
    parser.add_argument("--plot", default=RESULTS / "surface_cuts.svg")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("What each step of division is worth", (
        "model", "steps", "pieces", "angles < 20", "20–30", "30–40", "40–50", "≥ 50", "smallest", "cut edges", "imbalance", "rounds",
        "smallest angle at cuts", "worst mean ratio", "mean ratio, cuts / others"))
    smallest = {name: [] for name in VARIANTS}
    sharpest = {name: [] for name in VARIANTS}
    with tempfile.TemporaryDirectory() as folder:
        for file in options.files:
            case = write_case(file, folder, options.piece_triangles)
            for name, without in VARIANTS.items():
                r, details = run_with_details(options.program, case, folder, *(["--without", without] if without else []))
                table.add(*(row(file.stem, name, r, details) if r else (file.stem, name, "no mesh")))
                smallest[name].append(float(r["cut_angle_min"]) if r else None)
                sharpest[name].append(float(r["cut_min_angle"]) if r else None)
    table.save(options.page)
    rows = [file.stem for file in options.files]
    panels = [Panel("Smallest angle where cuts end", "degrees", x=(0, 90), rows=rows, width=560),
              Panel("Smallest angle of triangles at cuts", "degrees", x=(0, 60), rows=rows, width=460)]
    panels[0].guide(x=40, name="40")
    for kind, name in enumerate(VARIANTS):
        panels[0].points(name, smallest[name], kind=kind)
        panels[1].points(name, sharpest[name], kind=kind)
    save(options.plot, panels)


if __name__ == "__main__":
    main()
