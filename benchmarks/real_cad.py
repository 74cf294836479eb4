#!/usr/bin/env python3
"""Meshes every geometry of a collection, CAD or triangles, with `geometry: file` alone and prints a table in Markdown.

The collection is a folder; an INDEX.md in it or above it, where there is one, tells each file's class: A and B are to mesh,
C is to end in a diagnosis. Every mesh is checked by an independent arbiter (--arbiter, called as
`ARBITER mesh.pvtu --surface surface.pvtp`) where one is given, else by the program's own checks alone.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time

from far_fields import FAR_FIELDS
from printed_table import PrintedTable, add_page_option

SUFFIXES = {".step", ".stp", ".igs", ".iges", ".brep", ".stl", ".obj", ".off", ".ply", ".poly", ".smesh"}
LIMIT_S = 300

Row = collections.namedtuple("Row", "name kind code valid tetrahedra angle apart seconds sizing memory hash message")


def read_classes(folder):
    """File name -> class, from the tables of an INDEX.md."""
    index = next((place / "INDEX.md" for place in (folder, folder.parent) if (place / "INDEX.md").exists()), None)
    if index is None:
        return {}
    rows = re.findall(r"^\| (\S+) \| ([ABC]) \|", index.read_text(), re.MULTILINE)
    return dict(rows)


def launch(options, case):
    command = [options.program, "run", str(case)]
    if options.ranks > 1:
        command = [options.launcher, str(options.ranks)] + command
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=LIMIT_S)
        return done.returncode, done.stdout + done.stderr, time.monotonic() - start
    except subprocess.TimeoutExpired:
        return None, f"error: more than {LIMIT_S} s", time.monotonic() - start


def judge(options, output):
    """What the arbiter says, else None."""
    if not options.arbiter:
        return None
    command = [options.arbiter, output / "mesh.pvtu", "--surface", output / "surface.pvtp"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return "VALID yes" in done.stdout


def first_error(log):
    for line in log.splitlines():
        if line.startswith("error"):
            return line.removeprefix("error: ")
    return ""


def least_angle_apart(report):
    """The smallest dihedral angle apart from tetrahedra that the CAD forces and those at unresolved features, as text:
    a dash where no other misses the target."""
    angle = report["improve"]["below_target"]["rest"]["smallest_dihedral_deg"]
    return "–" if angle is None else f"{angle:.1f}"


def mesh_file(options, file, kind):
    with tempfile.TemporaryDirectory(prefix="real_cad_", dir=options.scratch) as scratch:
        output = pathlib.Path(scratch) / "out"
        case = pathlib.Path(scratch) / "case.yaml"
        case.write_text(json.dumps({"geometry": {"file": str(file)}, "patches": FAR_FIELDS.get(file.name, {}), "output": {"directory": str(output)}}))
        code, log, seconds = launch(options, case)
        if code != 0:
            return Row(file.name, kind, code, None, 0, 0, "", seconds, 0, 0, "", first_error(log))
        report = json.loads((output / "report.json").read_text())
        valid = judge(options, output)
        if options.keep:
            shutil.copytree(output, pathlib.Path(options.keep) / file.name, dirs_exist_ok=True)
        memory = max(stage["peak_rss_bytes_sum"] for stage in report["stages"])
        sizing = next(stage["wall_seconds"] for stage in report["stages"] if stage["name"] == "sizing")
        return Row(file.name, kind, code, valid, report["mesh"]["tetrahedra"],
                   report["quality"]["min_dihedral_deg"], least_angle_apart(report), seconds, sizing, memory, report["mesh"]["hash"], "")


def cells_of(row, folder):
    outcome = {True: "valid", None: "mesh", False: "INVALID"}[row.valid] if row.code == 0 else f"exit {row.code}"
    figures = (f"{row.tetrahedra:,}", f"{row.angle:.1f}", row.apart, f"{row.seconds:.0f}", f"{row.sizing:.1f}",
               f"{row.memory / 2**30:.1f}", row.hash[:8])
    if row.code != 0:
        figures = ("", "", "", f"{row.seconds:.0f}", "", "", "")
    message = row.message.replace(f"{folder}/", "").replace("|", "/")
    return row.name, row.kind, outcome, *figures, message


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/release/bin/aeroloom")
    parser.add_argument("--launcher", default="scripts/mpirun_local.sh", help="called as LAUNCHER RANKS PROGRAM ...")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="files at a time")
    parser.add_argument("--arbiter", help="an independent checker of meshes")
    parser.add_argument("--only", nargs="*", help="names of files")
    parser.add_argument("--classes", default="ABC")
    parser.add_argument("--keep", help="folder for the outputs")
    parser.add_argument("--scratch", help="folder for what is deleted afterwards")
    add_page_option(parser)
    parser.add_argument("--section", default="CAD", help="heading of the table on the page")
    options = parser.parse_args()

    classes = read_classes(options.folder)
    files = sorted(f for f in options.folder.rglob("*") if f.suffix.lower() in SUFFIXES)
    files = [f for f in files if not options.only or f.name in options.only]
    files = [f for f in files if classes.get(f.name, options.classes[0]) in options.classes]
    table = PrintedTable(options.section, ("file", "class", "outcome", "tetrahedra", "smallest dihedral", "apart from CAD and features",
                                           "s", "of it sizing", "GiB", "hash", "message"))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        work = [pool.submit(mesh_file, options, f, classes.get(f.name, "")) for f in files]
        rows = [None] * len(work)
        for i, each in enumerate(work):
            rows[i] = each.result()
            table.add(*cells_of(rows[i], str(files[i].parent)))
    meshable = [row for row in rows if row.kind in "AB"]
    good = sum(row.code == 0 and row.valid is not False for row in meshable)
    note = f"{good} of {len(meshable)} files that are to mesh do; longest run {max(r.seconds for r in rows):.0f} s."
    print(f"\n{note}")
    table.save(options.page, note)


if __name__ == "__main__":
    main()
