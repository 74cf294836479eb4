#!/usr/bin/env python3
"""Triangles at cuts against those elsewhere, with a test of equivalence, and one piece against many, with histograms.

usage: surface_quality.py SURFACE_BENCHMARK [FILE ...] [--program AEROLOOM] [--piece-triangles N] [--plots FOLDER]
           [--page FILE]

Cuts are those that the surface stage made: borders between pieces of one CAD face. Two one-sided tests (Schuirmann,
J. Pharmacokinet. Biopharm. 15, 1987, doi:10.1007/BF01068419) at 5 % each: means are equivalent where the 90 % confidence
interval of their difference lies within the margin, one degree for the smallest angle and half a per cent for the mean
ratio. Triangles beside each other are alike, so the pieces are the samples, not the triangles: variances are those of
ratios over clusters (Cochran, Sampling Techniques, 1977, chapter 9A).

Each model is compared twice: all triangles with a vertex on a cut against all others; and like with like, without those that
have a vertex on a CAD curve, and in the faces that were cut alone.

With --program the volumes are made too, at the same pieces and in one, and their dihedral angles are in the histograms.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile

from plots import Panel, save
from printed_table import PrintedTable, add_page_option
from surface_runs import FILES, RESULTS, ROOT, run_with_details, t_quantile, write_case

ANGLE_MARGIN, RATIO_MARGIN = 1.0, 0.5  # degrees, per cent
CUT, CUT_AND_CURVE, CURVE, INSIDE = range(4)
COMPARISONS = {"all triangles": ([CUT, CUT_AND_CURVE], [CURVE, INSIDE], False), "like with like": ([CUT], [INSIDE], True)}
WITH_HISTOGRAMS = ("sphere", "gmsh_dlr_f6", "su2_oneram6")
ONE_PIECE = ["surface.piece_triangles=1e9", "volume.piece_tets=1e9"]


def difference(pieces, measure, at, elsewhere):
    """The mean at cuts less the mean elsewhere, half its 90 % confidence interval, and the mean elsewhere."""
    total = lambda piece, groups, name: sum(piece[name][k] for k in groups)
    n, m = (sum(total(p, groups, "count") for p in pieces) for groups in (at, elsewhere))
    mean_at, mean_elsewhere = (sum(total(p, groups, measure) for p in pieces) / count
                               for groups, count in ((at, n), (elsewhere, m)))
    used = [p for p in pieces if total(p, at, "count") + total(p, elsewhere, "count") > 0]
    errors = [(total(p, at, measure) - mean_at * total(p, at, "count")) / n -
              (total(p, elsewhere, measure) - mean_elsewhere * total(p, elsewhere, "count")) / m for p in used]
    samples = sum(total(p, at, "count") > 0 for p in used)
    variance = len(used) / (len(used) - 1) * math.fsum(e * e for e in errors)
    return mean_at - mean_elsewhere, t_quantile(0.95, samples - 1) * math.sqrt(variance), mean_elsewhere


def compare(details, at, elsewhere, cut_faces_alone):
    pieces = details["pieces"]
    if cut_faces_alone:
        faces = [p["face"] for p in pieces]
        many = {face for face in set(faces) if faces.count(face) > 1}
        pieces = [p for p in pieces if p["face"] in many]
    if sum(sum(p["count"][k] for k in at) > 0 for p in pieces) < 6:
        return None
    count = [sum(p["count"][k] for p in pieces for k in groups) for groups in (at, elsewhere)]
    angle, angle_half, _ = difference(pieces, "angle_sum", at, elsewhere)
    ratio, ratio_half, mean = difference(pieces, "ratio_sum", at, elsewhere)
    return {"count": count, "angle": angle, "angle_half": angle_half, "ratio": 100 * ratio / mean,
            "ratio_half": 100 * ratio_half / mean}


def verdict(middle, half, margin):
    if abs(middle) + half < margin:
        return "holds"
    if middle - half >= margin:
        return "better at cuts"
    return "worse at cuts" if middle + half <= -margin else "open"


def tabulate(options, files, folder):
    rows = {name: {} for name in COMPARISONS}
    table = PrintedTable("Triangles at cuts against others", (
        "model", "compared", "pieces", "at cuts", "elsewhere", "smallest angle, difference in degrees", "within 1",
        "mean ratio, difference in %", "within 0.5 %"))
    for file in files:
        case = write_case(file, folder, options.piece_triangles)
        figures, details = run_with_details(options.benchmark, case, folder)
        for name, comparison in COMPARISONS.items():
            found = compare(details, *comparison) if figures else None
            rows[name][file.stem] = found
            if not found:
                table.add(file.stem, name, "no mesh" if not figures else "too few cuts")
                continue
            at, elsewhere = found["count"]
            table.add(file.stem, name, figures["pieces"], f"{at:,.0f}", f"{elsewhere:,.0f}",
                      f"{found['angle']:+.2f} ± {found['angle_half']:.2f}",
                      verdict(found["angle"], found["angle_half"], ANGLE_MARGIN),
                      f"{found['ratio']:+.3f} ± {found['ratio_half']:.3f}",
                      verdict(found["ratio"], found["ratio_half"], RATIO_MARGIN))
    table.save(options.page)
    return rows


def draw_intervals(path, names, rows):
    panels = [Panel("Smallest angle, at cuts less elsewhere", "degrees", rows=names, width=540, x=(-3, 5)),
              Panel("Mean ratio, at cuts less elsewhere", "% of the mean elsewhere", rows=names, width=460, x=(-1, 2))]
    for panel, what, margin in zip(panels, ("angle", "ratio"), (ANGLE_MARGIN, RATIO_MARGIN)):
        for side in (-margin, margin):
            panel.guide(x=side)
        for kind, (comparison, found) in enumerate(rows.items()):
            got = [found.get(name) for name in names]
            panel.points(comparison, [g and g[what] for g in got],
                         [g and (g[what] - g[f"{what}_half"], g[what] + g[f"{what}_half"]) for g in got], kind=1 - kind)
    save(path, panels)


def volume_histogram(options, case, settings, folder):
    out = pathlib.Path(folder) / "volume"
    command = [ROOT / "scripts/mpirun_local.sh", "1", options.program, "run", case]
    for setting in [f"output.directory={out}", "output.pictures=false", *settings]:
        command += ["--set", setting]
    subprocess.run([str(c) for c in command], check=True, capture_output=True, cwd=ROOT)
    return json.loads((out / "report.json").read_text())["quality"]["min_dihedral"]["histogram"]


def shares(counts):
    """Per cent; empty bins are not drawn on a logarithmic axis."""
    total = sum(counts)
    return [100 * count / total for count in counts]


def draw_histograms(options, path, files, folder):
    panels = []
    for file in files:
        case = write_case(file, folder, options.piece_triangles)
        by = {name: run_with_details(options.benchmark, case, folder, *settings)[1]
              for name, settings in (("one piece per face", ONE_PIECE[:1]), ("pieces", []))}
        for what, key, low, width in (("smallest angle of triangles", "angle_histograms", 0, 2),
                                      ("mean ratio of triangles", "ratio_histograms", 0, 0.01)):
            panel = Panel(f"{file.stem}: {what}", "degrees" if width == 2 else "", "% of triangles", y_log=10, y=(1e-3, 100),
                          x=(0, 60) if width == 2 else (0.4, 1), width=380)
            for name, details in by.items():
                counts = [sum(column) for column in zip(*details[key])]
                panel.steps(name, [low + width * i for i in range(len(counts) + 1)], shares(counts))
            panels.append(panel)
        if options.program:
            panel = Panel(f"{file.stem}: smallest dihedral angle", "degrees", "% of tetrahedra", y_log=10, y=(1e-4, 100),
                          x=(0, 72), width=380)
            for name, settings in (("one piece per face", ONE_PIECE), ("pieces", ["volume.piece_tets=50000"])):
                found = volume_histogram(options, case, settings, folder)
                step = (found["high"] - found["low"]) / len(found["counts"])
                panel.steps(name, [found["low"] + step * i for i in range(len(found["counts"]) + 1)], shares(found["counts"]))
            panels.append(panel)
    save(path, panels, columns=3 if options.program else 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", type=os.path.abspath)
    parser.add_argument("files", nargs="*", type=pathlib.Path, default=[file for file in FILES if file.exists()])
    parser.add_argument("--program", type=os.path.abspath)
    parser.add_argument("--piece-triangles", type=int, default=1500)
    parser.add_argument("--plots", type=pathlib.Path, default=RESULTS)
    add_page_option(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = tabulate(options, options.files, folder)
        draw_intervals(options.plots / "surface_equivalence.svg", [file.stem for file in options.files], rows)
        draw_histograms(options, options.plots / "quality_histograms.svg",
                        [file for file in options.files if file.stem in WITH_HISTOGRAMS], folder)


if __name__ == "__main__":
    main()
