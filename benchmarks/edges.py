#!/usr/bin/env python3
"""What meshes make of thin trailing edges, and how near forecasts come, as a Markdown table.

usage: edges.py PROGRAM [--wings WINGS] [--arbiter CHECKER] [--only PART ...] [--folder CAD --files FILE ...]
                [--page FILE]

For each case: the forecast of `aeroloom check`, and a run on so many ranks (default 1). With --files, CAD files of a
folder with all sizes from the model instead of the cases. Counts of tetrahedra in thousands. Angles in degrees: of all
tetrahedra, apart from those that the CAD forces (pinned), and apart from those at unresolved features as well; a dash
where no such one misses the target. CHECKER is an independent checker of meshes, called as
`CHECKER mesh.pvtu --surface surface.pvtp`; WINGS is benchmarks/wings of the build.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from printed_table import PrintedTable, add_page_option
from whole_run import verdict

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "configs/acceptance"
DEFAULT_BUDGET = 5
# Case, settings beside it, ranks.
RUNS = [
    ("edges_transport_1", [], 1),
    ("edges_transport_0_3", [], 1),
    ("edges_transport_0_1", [], 1),
    ("edges_transport_0_1", ["sizing.feature_budget=15"], 1),
    ("edges_transport_0_03", [], 1),
    ("edges_transport_0_03_half_span", [], 1),
    ("edges_transport_1_sharp", [], 1),
    ("edges_transport_0_3_sharp", [], 1),
    ("edges_transport_0_1_sharp", [], 1),
    ("edges_transport_0_03_sharp", [], 1),
    ("edges_wing_separate", [], 1),
    ("edges_wing_tapered", [], 1),
    ("edges_wing_partly_sharp", [], 1),
    ("edges_transport_0_03_half_span", ["sizing.feature_budget=50"], 2),
]
WINGS = {"separate": "igs", "tapered": "step", "partly_sharp": "step"}


def call(command):
    done = subprocess.run([str(c) for c in command], cwd=ROOT, capture_output=True, text=True, errors="replace", check=False)
    if done.returncode != 0:
        said = done.stdout + done.stderr
        raise RuntimeError(next((line for line in said.splitlines() if line.startswith("error")), said[-400:]))
    return done.stdout


def write_wings(program):
    """The wings' cases name files in `out`."""
    (ROOT / "out").mkdir(exist_ok=True)
    for name, suffix in WINGS.items():
        call([program, name, ROOT / "out" / f"wing_{name}.{suffix}"])


def cpu_seconds(stage):
    """Of all ranks; what a stage does beside its tasks is alike on each."""
    return stage["cpu_seconds_mean"] + stage["check_seconds"] + stage["other_seconds"]


def least_angles(report):
    """Of all; apart from pinned; apart from pinned and unresolved ones; and how many of all are below 10 degrees."""
    kinds = report["improve"]["below_target"]
    rest = kinds["rest"]["smallest_dihedral_deg"]
    apart = [angle for angle in (rest, kinds["unresolved_features"]["smallest_dihedral_deg"]) if angle is not None]
    counts = report["quality"]["min_dihedral"]["histogram"]
    low, high, bins = counts["low"], counts["high"], counts["counts"]
    below = sum(n for k, n in enumerate(bins) if low + (high - low) * (k + 1) / len(bins) <= 10 + 1e-9)
    angles = [report["quality"]["min_dihedral_deg"], min(apart, default=None), rest]
    return [f"{angle:.1f}" if angle is not None else "–" for angle in angles], below


def row(options, case, settings, ranks, folder):
    """Cells of the table behind the label and the budget."""
    settings = [word for setting in [*settings, f"output.directory={folder}"] for word in ("--set", setting)]
    call([options.program, "check", case, *settings])
    forecast = json.loads((folder / "check.json").read_text())["forecast"]
    call([ROOT / "scripts/mpirun_local.sh", ranks, options.program, "run", case, *settings])
    report = json.loads((folder / "report.json").read_text())
    made, predicted = report["mesh"]["tetrahedra"], forecast["tetrahedra"]
    (least, unpinned, rest), below = least_angles(report)
    stages = {stage["name"]: cpu_seconds(stage) for stage in report["stages"]}
    told = "yes" if report["unresolved_features"] or report["sizing"]["features"]["unresolved"] else "no"
    seconds = f"{report['wall_seconds']:.0f}{f' on {ranks} ranks' if ranks > 1 else ''}"
    return (f"{predicted / 1e3:,.0f}", f"{made / 1e3:,.0f}", f"{predicted / made:.2f}", least, unpinned, rest, f"{below:,}",
            f"{100 * stages['improve'] / sum(stages.values()):.0f} %", seconds, verdict(options, folder), told, report["mesh"]["hash"][:8])


def works(options, scratch):
    """Name, budget, case, settings, ranks."""
    if options.files is not None:
        for name in options.files:
            case = pathlib.Path(scratch) / "case.yaml"
            case.write_text(json.dumps({"geometry": {"file": str(next(options.folder.rglob(name)))}}))
            yield name, DEFAULT_BUDGET, case, [], 1
        return
    for case, settings, ranks in RUNS:
        budget = re.findall(r"feature_budget=(\d+)", " ".join(settings))
        if not options.only or any(part in case for part in options.only):
            yield case, budget[-1] if budget else DEFAULT_BUDGET, CASES / f"{case}.yaml", settings, ranks


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--wings", default=ROOT / "build/release/benchmarks/wings")
    parser.add_argument("--arbiter")
    parser.add_argument("--only", nargs="*", help="parts of the cases' names")
    parser.add_argument("--folder", type=pathlib.Path, help="of CAD files")
    parser.add_argument("--files", nargs="*", help="of that folder, instead of the cases")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the outputs")
    add_page_option(parser)
    options = parser.parse_args()
    if options.files is None:
        write_wings(options.wings)
    table = PrintedTable("Cases" if options.files is None else "Other CAD", (
        "case", "budget", "predicted, thousands", "made", "ratio", "least angle", "apart from pinned", "and from unresolved", "below 10",
        "improve's CPU", "s", "valid", "tells of unresolved", "hash"))
    with tempfile.TemporaryDirectory() as scratch:
        for number, (name, budget, case, settings, ranks) in enumerate(works(options, scratch)):
            folder = options.keep / f"{pathlib.Path(name).name}{''.join(settings).replace('sizing.', '_')}" if options.keep else pathlib.Path(scratch) / str(number)
            try:
                table.add(f"`{name}`", budget, *row(options, case, settings, ranks, folder))
            except RuntimeError as error:
                table.add(f"`{name}`", budget, error)
    table.save(options.page)


if __name__ == "__main__":
    sys.exit(main())
