#!/usr/bin/env python3
"""The surface stage over rank counts with both schemes, one task per CAD face and pieces, as a Markdown table and plots.

usage: surface_balance.py SURFACE_BENCHMARK [CASE ...] [--ranks N ...] [--repeats N] [--plot FILE] [--page FILE]

Cases are files; configs/acceptance/surface_{sphere,submarine,d150}.yaml where none is given: one face, a dozen, and
hundreds. Figures are CPU time of the tasks, so ranks may share cores: speed-up is the CPU of one rank with a task per
face over that of the busiest rank. Serial is work of one rank alone, and work repeated on all of them, over the stage's
total. Of the repeats, taken in turn, the one with the median of busiest / mean counts.
"""
import argparse
import os
import pathlib

from plots import Panel, save
from printed_table import PrintedTable, add_page_option
from surface_runs import RESULTS, ROOT, run

CASES = [ROOT / f"configs/acceptance/surface_{name}.yaml" for name in ("sphere", "submarine", "d150")]
SCHEMES = {"faces": "a task per face", "pieces": "pieces"}


def measure(options, case):
    """Figures by scheme and ranks; nothing where a run failed."""
    runs = {(scheme, ranks): [] for scheme in SCHEMES for ranks in options.ranks}
    for _ in range(options.repeats):
        for (scheme, ranks), of in runs.items():
            found = run(options.program, case, f"surface.decomposition={scheme}", ranks=ranks)
            if found:
                of.append({name: float(found[name]) if name != "hash" else found[name] for name in (
                    "pieces", "triangles", "cpu_total", "cpu_max", "busiest", "serial_share", "load_error_90", "hash")})
    return {key: sorted(of, key=lambda r: r["busiest"])[len(of) // 2] if of else None for key, of in runs.items()}


def draw(path, ranks, measured):
    panels = []
    for name, by in measured.items():
        alone = by["faces", ranks[0]]
        speed, balance = (Panel(f"{name}: {what}", "ranks", what, x_log=2, x=(ranks[0], ranks[-1]), **more) for what, more in (
            ("speed-up", dict(y_log=2, y=(1, ranks[-1]))), ("busiest / mean", dict(y=(1, 2)))))
        speed.guide(x=True, y=True, name="ideal")
        balance.guide(y=1.1, name="1.1")
        for kind, (scheme, label) in enumerate(SCHEMES.items()):
            rows = [(n, by[scheme, n]) for n in ranks if by[scheme, n]]
            if alone:
                speed.line(label, [n for n, _ in rows], [alone["cpu_max"] / r["cpu_max"] for _, r in rows], 1 - kind)
            # What is above the plot says nothing more.
            rows = [(n, r) for n, r in rows if r["busiest"] <= 2]
            balance.line(label, [n for n, _ in rows], [r["busiest"] for _, r in rows], 1 - kind)
        panels += [speed, balance]
    save(path, panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("cases", nargs="*", type=pathlib.Path, default=CASES)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8, 16, 32, 64])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--plot", default=RESULTS / "surface_balance.svg")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("A task per face against pieces", (
        "case", "scheme", "ranks", "pieces", "triangles", "CPU s", "busiest CPU s", "speed-up", "busiest / mean", "serial",
        "90 % of loads within", "hash"))
    measured = {}
    for case in options.cases:
        name = case.stem.removeprefix("surface_")
        measured[name] = by = measure(options, case)
        alone = by["faces", options.ranks[0]]
        for (scheme, ranks), r in by.items():
            if not r:
                table.add(name, scheme, ranks, "failed")
                continue
            speed_up = f"{alone['cpu_max'] / r['cpu_max']:.2f}" if alone else "–"
            table.add(name, scheme, ranks, f"{r['pieces']:.0f}", f"{r['triangles']:,.0f}", f"{r['cpu_total']:.2f}",
                      f"{r['cpu_max']:.3f}", speed_up, f"{r['busiest']:.3f}", f"{100 * r['serial_share']:.1f} %",
                      f"{100 * r['load_error_90']:.0f} %", r["hash"][:8])
    table.save(options.page)
    draw(options.plot, options.ranks, measured)


if __name__ == "__main__":
    main()
