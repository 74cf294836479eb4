#!/usr/bin/env python3
"""Meshes CAD files with one small mistake each, made by mutate_cad, and prints a table in Markdown.

usage: cad_mutations.py [--build BUILD] [--count N] [--seed S] [--target T] [--arbiter ARBITER] [--keep FOLDER] [--page FILE] FILE...

N seeds from S on, each with the file that is its number modulo that of files; what a mutation is follows from its seed
(mutate_cad.cpp). Written as STEP and BREP by turns of five, IGES files as IGES instead of STEP; loosened tolerances as BREP. Each must end in a valid mesh, or in
a message that names a place, within 120 s, and no zone be tried more than twice.
"""
import argparse
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from printed_table import PrintedTable, add_page_option

LIMIT_S = 120
KINDS = ["vertex moved", "edge split", "face offset", "sliver inserted", "tolerances loosened"]

Row = collections.namedtuple("Row", "file seed kind share code angle tetrahedra retries seconds closed message good")


def mutate(options, file, seed, folder):
    """The mutated file and what was done, or None and why not."""
    brep = seed % len(KINDS) == 4 or (seed // len(KINDS)) % 2 == 1
    suffix = ".brep" if brep else ".igs" if file.suffix == ".igs" else ".step"
    out = folder / f"{file.stem}_{seed}{suffix}"
    done = subprocess.run([options.build / "benchmarks" / "mutate_cad", file, str(seed), out], capture_output=True, text=True,
                          timeout=LIMIT_S, check=False)
    return (out, done.stdout.strip()) if done.returncode == 0 else (None, done.stderr.strip())


def mesh(options, file, folder):
    case, output = folder / "case.yaml", folder / "out"
    case.write_text(f'geometry: {{file: "{file}"}}\nsizing: {{target_tetrahedra: {options.target}}}\n'
                    f'output: {{directory: "{output}", pictures: false}}\n')
    start = time.monotonic()
    try:
        done = subprocess.run([options.build / "bin" / "aeroloom", "run", case], capture_output=True, text=True,
                              errors="replace", timeout=LIMIT_S, check=False)
        code, log = done.returncode, done.stdout + done.stderr
    except subprocess.TimeoutExpired:
        code, log = -1, f"error: more than {LIMIT_S} s"
    return code, log, time.monotonic() - start, output


def judge(options, output):
    """What an independent arbiter says; True where there is none."""
    if not options.arbiter:
        return True
    done = subprocess.run([options.arbiter, output / "mesh.pvtu", "--surface", output / "surface.pvtp"], capture_output=True,
                          text=True, check=False)
    return "VALID yes" in done.stdout


def one(options, file, seed):
    kind = KINDS[seed % len(KINDS)]
    with tempfile.TemporaryDirectory(prefix="mutation_") as name:
        folder = pathlib.Path(options.keep or name)
        folder.mkdir(parents=True, exist_ok=True)
        mutated, what = mutate(options, file, seed, folder)
        if mutated is None:
            return Row(file.name, seed, kind, "", None, None, None, 0, 0, 0, what, True)
        share = re.search(r"([\d.e-]+) of the diagonal", what).group(1)
        code, log, seconds, output = mesh(options, mutated, folder)
        closed = len(re.findall(r"below the noise of .*: closed", log))
        errors = [line for line in log.splitlines() if line.startswith("error")]
        if code != 0:
            message = errors[0].removeprefix("error: ").replace(f"{mutated.parent}/", "") if errors else "no message"
            placed = re.search(r"\([-\d.e+]+, [-\d.e+]+, [-\d.e+]+\)", message) is not None
            good = code > 0 and placed and seconds <= LIMIT_S
            return Row(file.name, seed, kind, share, code, None, None, 0, seconds, closed, message, good)
        report = json.loads((output / "report.json").read_text())
        zones = collections.Counter(retry.get("zone") for retry in report["volume"]["retries"])
        retries = max(zones.values(), default=0)
        valid = judge(options, output)
        return Row(file.name, seed, kind, share, code, report["quality"]["min_dihedral_deg"], report["mesh"]["tetrahedra"],
                   retries, seconds, closed, "" if valid else "INVALID", valid and retries <= 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "build/release")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--target", type=int, default=20000)
    parser.add_argument("--arbiter")
    parser.add_argument("--keep")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Files", ("file", "seed", "mutation", "share of the diagonal", "exit", "smallest dihedral", "tetrahedra", "retries",
                                   "s", "closed", "message"))
    bad = 0
    for seed in range(options.seed, options.seed + options.count):
        row = one(options, options.files[seed % len(options.files)], seed)
        bad += not row.good
        angle = "" if row.angle is None else f"{row.angle:.1f}"
        code = "not mutated" if row.code is None else row.code
        table.add(row.file, row.seed, row.kind, row.share, code, angle, row.tetrahedra or "", row.retries, f"{row.seconds:.0f}",
                  row.closed, f"{'**not as wanted** ' if not row.good else ''}{row.message}")
    note = f"{options.count} mutations, {bad} not as wanted"
    print(f"\n{note}")
    table.save(options.page, f"{note}.")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
