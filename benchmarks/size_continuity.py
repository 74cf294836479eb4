#!/usr/bin/env python3
"""Asks `aeroloom check` how many tetrahedra an annulus between eccentric cylinders takes, by eccentricity and target, and judges the steps.

The gap between a cylinder of radius 1 and one of 0.98 narrows with the eccentricity e, from 0.02 to 0.02 (1 - e): sizes follow it,
and below some target the count is that of one element across the gap. The forecasts are to be continuous: above the least target that
the warning names, within 1.3 of the neighbours in eccentricity and 1.3 to 1.7 times as many for a target 1.5 times as large; below it
the count of the least one, within 1.4. Six are meshed too. Needs gmsh 4.8 or later on the path.
"""
import argparse
import collections
import json
import pathlib
import re
import subprocess
import tempfile

from printed_table import PrintedTable, add_page_option
from real_cad import first_error, judge, launch

GEO = """SetFactory("OpenCASCADE");
Cylinder(1) = {{0,0,0, 0,0,1, 1.0}};
Cylinder(2) = {{{shift},0,0, 0,0,1, 0.98}};
BooleanDifference(3) = {{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }};
"""
ECCENTRICITIES = [0.05 * i for i in range(19)]
TARGETS = [1e4 * 1.5**k for k in range(15)]
STEP, GROWTH = 1.3, (1.3, 1.7)  # wanted of neighbours in eccentricity and in target
WITHIN = 1.4  # of the least target's count
MESHED = [(0, 500_000), (0.2, 60_000), (0.2, 600_000), (0.5, 600_000), (0.8, 60_000), (0.8, 1_500_000)]
Forecast = collections.namedtuple("Forecast", "tetrahedra least")


def make_annulus(folder, e):
    path = folder / f"annulus_{e:g}.brep"
    if not path.exists():
        source = folder / "annulus.geo"
        source.write_text(GEO.format(shift=0.02 * e))
        subprocess.run(["gmsh", source, "-0", "-v", "2", "-o", path, "-format", "brep"], check=True)
    return path


def write_case(folder, file, target):
    case = folder / "case.yaml"
    case.write_text(json.dumps({"geometry": {"file": str(file), "domain": "fluid"}, "sizing": {"target_tetrahedra": target},
                                "output": {"directory": str(folder / "out"), "pictures": False}}))
    return case


def forecast(program, case):
    done = subprocess.run([program, "check", case], capture_output=True, text=True, check=False)
    text = done.stdout + done.stderr
    count = re.search(r"a run: about \S+ triangles, ([\d.e+]+) tetrahedra", text)
    if not count:
        raise RuntimeError(f"no forecast: {text}")
    least = re.search(r"least target that this case meets is about ([\d.e+]+\d)", text)
    return Forecast(float(count.group(1)), float(least.group(1)) if least else None)


def find_faults(forecasts):
    """What is not continuous, as sentences. The least target of an eccentricity is the largest one that its warnings name."""
    faults = []
    eccentricities, targets = ECCENTRICITIES, TARGETS
    least = {e: max(forecasts[e, target].least or 0 for target in targets) for e in eccentricities}
    for i, e in enumerate(eccentricities):
        for k, target in enumerate(targets):
            count = forecasts[e, target].tetrahedra
            if target < least[e]:
                if not 1 / WITHIN <= count / least[e] <= WITHIN:
                    faults.append(f"{e:g}, {target:.3g}: {count:.3g} where the least target is {least[e]:.3g}")
                continue
            if i + 1 < len(eccentricities) and target >= least[eccentricities[i + 1]]:
                ratio = forecasts[eccentricities[i + 1], target].tetrahedra / count
                if not 1 / STEP <= ratio <= STEP:
                    faults.append(f"{e:g} to {eccentricities[i + 1]:g}, {target:.3g}: {ratio:.2f} times as many")
            if k + 1 < len(targets):
                ratio = forecasts[e, targets[k + 1]].tetrahedra / count
                if not GROWTH[0] <= ratio <= GROWTH[1]:
                    faults.append(f"{e:g}, {target:.3g} to {targets[k + 1]:.3g}: {ratio:.2f} times as many")
    return faults


def tabulate(options, folder):
    """The forecasts, a row an eccentricity, and what they are faulted for."""
    table = PrintedTable("Forecasts", ["eccentricity", "least target", *(f"{target:.3g}" for target in TARGETS)])
    forecasts = {}
    for e in ECCENTRICITIES:
        file = make_annulus(folder, e)
        for target in TARGETS:
            forecasts[e, target] = forecast(options.program, write_case(folder, file, target))
        named = [forecasts[e, target].least for target in TARGETS if forecasts[e, target].least]
        table.add(f"{e:g}", f"{max(named):.3g}" if named else "–", *(f"{forecasts[e, target].tetrahedra:.3g}" for target in TARGETS))
    faults = find_faults(forecasts)
    print("\n".join(["", f"{len(faults)} faults of {len(forecasts)} forecasts", *faults, ""]))
    table.save(options.page, "\n".join([f"{len(faults)} of {len(forecasts)} forecasts or steps are not as they should be:", "",
                                       *(f"- {each}" for each in faults)]))


def mesh_some(options, folder):
    table = PrintedTable("Meshed", ["eccentricity", "target", "forecast", "tetrahedra", "smallest dihedral", "valid", "s"])
    for e, target in MESHED:
        case = write_case(folder, make_annulus(folder, e), target)
        promised = forecast(options.program, case).tetrahedra
        code, log, seconds = launch(options, case)
        if code != 0:
            table.add(f"{e:g}", f"{target:,}", f"{promised:,.0f}", f"exit {code}: {first_error(log)}")
            continue
        report = json.loads((folder / "out" / "report.json").read_text())
        table.add(f"{e:g}", f"{target:,}", f"{promised:,.0f}", f"{sum(report['quality']['min_dihedral']['histogram']['counts']):,}",
                  f"{report['quality']['min_dihedral_deg']:.1f}", {True: "yes", False: "no", None: "–"}[judge(options, folder / "out")],
                  f"{seconds:.0f}")
    table.save(options.page)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/aeroloom")
    parser.add_argument("--arbiter", help="an independent checker of meshes")
    parser.add_argument("--tables", nargs="*", choices=("forecasts", "meshed"), default=["forecasts", "meshed"])
    add_page_option(parser)
    options = parser.parse_args()
    options.ranks = 1
    with tempfile.TemporaryDirectory(prefix="continuity_") as scratch:
        folder = pathlib.Path(scratch)
        if "forecasts" in options.tables:
            tabulate(options, folder)
        if "meshed" in options.tables:
            mesh_some(options, folder)


if __name__ == "__main__":
    main()
