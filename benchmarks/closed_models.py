#!/usr/bin/env python3
"""Makes closed models, CAD by gmsh and triangles by formulas, meshes each at a target and prints a table in Markdown.

The models are those of closed_model_cad.py and closed_model_triangles.py: threads, fins, gears, blades, flanges, honeycombs, gyroids
and what comes near to itself. All are closed, none crosses itself, so all are to mesh. An independent arbiter judges the meshes
(--arbiter, as in real_cad.py). Runs on Python with numpy; gmsh 4.8 or later is on the path.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import tempfile

from closed_model_cad import CAD, make_cad
from closed_model_triangles import TRIANGLES
from printed_table import PrintedTable, add_page_option
from real_cad import first_error, judge, launch
from triangle_surfaces import faults, write_model

COLUMNS = ("model", "outcome", "tetrahedra", "of target", "smallest dihedral", "pinned", "strips and gaps", "held by surface", "neither",
           "s", "of it sizing", "hash", "message")
CLASSES = ("pinned", "unresolved_features", "held_by_surface", "rest")
Model = collections.namedtuple("Model", "file keys")


def make_models(folder, only):
    """Writes the models that are not there yet."""
    models = []
    for name, (_, ending, keys) in CAD.items():
        models.append(Model(folder / f"{name}.{ending}", keys))
        if chosen(models, only) and not models[-1].file.exists():
            make_cad(name, models[-1].file)
    for name, (make, ending) in TRIANGLES.items():
        models.append(Model(folder / f"{name}.{ending}", {}))
        if chosen(models, only) and not models[-1].file.exists():
            points, triangles = make()
            if fault := faults(points, triangles):
                raise RuntimeError(f"{name} is not closed: {fault}")
            write_model(models[-1].file, points, triangles)
    return [model for i, model in enumerate(models) if chosen(models[:i + 1], only)]


def chosen(models, only):
    return not only or models[-1].file.name in only


def angle_cell(report, name):
    """How many tetrahedra of a class miss the target of improvement, and the smallest angle."""
    group = report["improve"]["below_target"][name]
    angle = group["smallest_dihedral_deg"]
    return "–" if angle is None else f"{group['tetrahedra']:,} from {angle:.1f}"


def mesh_model(options, model):
    with tempfile.TemporaryDirectory(prefix="closed_", dir=options.scratch) as scratch:
        output, case = pathlib.Path(scratch) / "out", pathlib.Path(scratch) / "case.yaml"
        sizing = {"sizing": {"target_tetrahedra": options.target}} if options.target else {}
        case.write_text(json.dumps({"geometry": {"file": str(model.file), **model.keys}, **sizing,
                                    "output": {"directory": str(output), "pictures": False}}))
        code, log, seconds = launch(options, case)
        if code != 0:
            message = first_error(log).replace(f"{model.file.parent}/", "").replace("|", "/")
            return (model.file.name, f"exit {code}", *[""] * 7, f"{seconds:.0f}", "", "", message)
        report = json.loads((output / "report.json").read_text())
        outcome = {True: "valid", None: "mesh", False: "INVALID"}[judge(options, output)]
        stage = next(stage["wall_seconds"] for stage in report["stages"] if stage["name"] == "sizing")
        tetrahedra = report["mesh"]["tetrahedra"]
        share = f"{tetrahedra / options.target:.2f}" if options.target else ""
        return (model.file.name, outcome, f"{tetrahedra:,}", share, f"{report['quality']['min_dihedral_deg']:.1f}",
                *[angle_cell(report, name) for name in CLASSES], f"{seconds:.0f}", f"{stage:.1f}", report["mesh"]["hash"][:8], "")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="for the models; those that are there are taken as they are")
    parser.add_argument("--program", default="build/release/bin/aeroloom")
    parser.add_argument("--launcher", default="scripts/mpirun_local.sh", help="called as LAUNCHER RANKS PROGRAM ...")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="models at a time")
    parser.add_argument("--target", type=int, help="tetrahedra; without it the program's own")
    parser.add_argument("--arbiter", help="an independent checker of meshes")
    parser.add_argument("--only", nargs="*", help="names of files")
    parser.add_argument("--scratch", help="folder for what is deleted afterwards")
    parser.add_argument("--section", default="Models", help="heading of the table on the page")
    add_page_option(parser)
    options = parser.parse_args()

    options.folder.mkdir(parents=True, exist_ok=True)
    models = make_models(options.folder.resolve(), options.only)
    table = PrintedTable(options.section, COLUMNS)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda model: mesh_model(options, model), models):
            table.add(*row)
    meshed = sum(row[1] in ("valid", "mesh") for row in table.rows)
    note = f"{meshed} of {len(models)} models mesh; longest run {max(int(row[9]) for row in table.rows)} s."
    print(f"\n{note}")
    table.save(options.page, note)


if __name__ == "__main__":
    main()
