#!/usr/bin/env python3
"""Boundary layers on every CAD file of a collection, as a Markdown table.

usage: layers.py FOLDER [--program PROGRAM] [--arbiter CHECKER] [--classes AB] [--target N] [--scratch DIR]
                 [--page FILE [--section HEADING]]

FOLDER is as in real_cad.py. First height 1e-5 of the longest side of the file's box, growth 1.2, until the last layer is about
isotropic, N cells aimed at (default 300,000), those of layers included. Area: percent of the walls whose columns have all layers, a last
layer of at least 0.35 of the mean edge, no layers, and the limit that keeps most of the rest. CHECKER is an independent checker of mixed
meshes, called as `CHECKER mesh.pvtu --surface surface.pvtp --walls WALLS`, WALLS the surface of a run without layers and without
improvement, with `--inner interfaces.pvtp --regions N` where there are several regions: tests/arbiters has one.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

from printed_table import PrintedTable, add_page_option
from real_cad import SUFFIXES, read_classes

LIMIT_S = 300


def run(program, case, output, *settings):
    command = [program, "run", case, "-q"]
    for setting in (f"output.directory={output}", "output.pictures=false", *settings):
        command += ["--set", setting]
    return subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S)


def longest_side(program, file):
    said = subprocess.run([program, "info", "--json", file], capture_output=True, text=True, timeout=LIMIT_S, check=True).stdout
    low, high = json.loads(said)["bounds"]
    return max(b - a for a, b in zip(low, high))


def verdict(options, folder, case):
    bare = run(options.program, case, folder / "bare", "improve.enabled=false")
    if bare.returncode != 0:
        return "no walls"
    command = [options.arbiter, folder / "out" / "mesh.pvtu", "--surface", folder / "out" / "surface.pvtp"]
    reports = [json.loads((folder / run / "report.json").read_text()) for run in ("out", "bare")]
    if (inner := folder / "out" / "interfaces.pvtp").exists():
        command += ["--inner", inner, "--regions", str(len(reports[0]["regions"]))]
    if reports[0]["sizing"] == reports[1]["sizing"]:  # a target counts tetrahedra off the layers, so sizes may be others without
        command += ["--walls", folder / "bare" / "surface.pvtp"]
    said = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S).stdout
    return "yes" if "VALID yes" in said else "NO"


def main_limit(layers):
    areas = {}
    for patch in layers["patches"]:
        for name, fraction in patch["limited"].items():
            areas[name] = areas.get(name, 0) + fraction * patch.get("area", 1)
    return max(areas, key=areas.get) if areas and max(areas.values()) > 0 else "–"


def isotropic_part(layers):
    area = sum(patch["area"] for patch in layers["patches"])
    return sum(patch["isotropic"] * patch["area"] for patch in layers["patches"]) / area if area > 0 else 0


def cells_of(options, file, folder):
    """The parts of the walls with all layers and with a high last one, None where there is no mesh; the cells of the table."""
    case = folder / "case.yaml"
    case.write_text(f"geometry: {{file: '{file.resolve()}'}}\nsizing: {{target_tetrahedra: {options.target}}}\n")
    start = time.monotonic()
    done = run(options.program, case, folder / "out", f"layers.first={1e-5 * longest_side(options.program, file):.4g}")
    seconds = time.monotonic() - start
    if done.returncode != 0:
        message = next((line for line in done.stderr.splitlines() if "error" in line), "").split("error", 1)[-1]
        return None, (file.name, *"–––––––", f"{seconds:.0f}", f"{done.returncode}: {message[2:100]}")
    report = json.loads((folder / "out" / "report.json").read_text())
    layers, mesh = report["layers"], report["mesh"]
    valid = verdict(options, folder, case) if options.arbiter else "–"
    isotropic = isotropic_part(layers)
    areas = [f"{100 * part:.1f}" for part in (layers["full"], isotropic, layers["empty"])]
    return (layers["full"], isotropic), (file.name, f"{mesh['prisms']:,}", f"{mesh['tetrahedra']:,}", *areas,
                                         f"{report['quality']['min_dihedral_deg']:.1f}", valid, f"{seconds:.0f}", main_limit(layers))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/release/bin/aeroloom")
    parser.add_argument("--arbiter")
    parser.add_argument("--classes", default="AB")
    parser.add_argument("--target", type=int, default=300_000)
    parser.add_argument("--scratch")
    add_page_option(parser)
    parser.add_argument("--section", default="CAD", help="heading of the table on the page")
    options = parser.parse_args()
    classes = read_classes(options.folder)
    files = sorted(f for f in options.folder.rglob("*") if f.suffix.lower() in SUFFIXES and classes.get(f.name, "A") in options.classes)
    table = PrintedTable(options.section, ("file", "prisms", "tetrahedra", "all layers, %", "high last layer, %", "none, %",
                                           "least angle", "valid", "s", "mostly limited by"))
    covered = []
    for file in files:
        with tempfile.TemporaryDirectory(dir=options.scratch) as folder:
            try:
                parts, cells = cells_of(options, file, pathlib.Path(folder))
            except (subprocess.TimeoutExpired, subprocess.CalledProcessError, KeyError) as error:
                parts, cells = None, (file.name, *"––––––––", type(error).__name__)
        covered += [] if parts is None else [parts]
        table.add(*cells)
    medians = [f"{100 * statistics.median(values):.1f} %" for values in zip(*covered)] or ["unknown", "unknown"]
    note = (f"{len(covered)} of {len(files)} files have a mesh; median of the area with all layers: {medians[0]}, "
            f"with a high last layer: {medians[1]}.")
    print(f"\n{note}")
    table.save(options.page, note)


if __name__ == "__main__":
    main()
