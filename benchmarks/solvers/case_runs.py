#!/usr/bin/env python3
"""Runs `simpleFoam` on cases as the program writes them, one after the other, and prints a table in Markdown.

usage: case_runs.py FOLDER [--program AEROLOOM] [--ranks N] [--iterations N] [--only NAME ...] [--page FILE]

Each case is meshed with layers at y+ 1 and at y+ 60, written for OpenFOAM and run by the script beside it, from uniform flow. What is
there already in FOLDER is not done again, so that a run that was stopped goes on. Nothing of the case is changed but the iterations and,
where a case has an angle of attack, directions in 0.orig/conditions. A case is good where all iterations are made, residuals of U and p
fall by a factor of 100, the speed stays below four times that of the free stream in all but the first 100 iterations, no turbulence is
clipped below minus 1 % of its average in the last 100, and drag (lift too, where it is larger) of the last two 50s agree within 3 %. Needs
OpenFOAM and, for some, gmsh.
"""
import argparse
import collections
import json
import math
import pathlib
import re
import subprocess
import sys

import written_case

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
from printed_table import PrintedTable, add_page_option  # pylint: disable=wrong-import-position

GEOMETRY = ROOT.parent / "shared" / "geometry"
FASTEST, FALL, AGREEMENT, CLIPPED = 4.0, 100.0, 0.03, 0.01
LAST = 50
#: Iterations before speeds count: 50 of first order, and as many after the change to second.
UNCOUNTED = 100
SPHERE = "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, 1};\n"
#: A macro of gmsh: the section at x, y, z of chord c, 12 % thick, with a trailing edge of twice `edge` chords.
SECTION = """SetFactory("OpenCASCADE");
Macro Section
  first = newp;
  For i In {0:40}
    t = Pi*i/40;
    s = 0.5*(1+Cos(t));
    h = 0.6*(0.2969*Sqrt(s)+s*(-0.126+s*(-0.3516+s*(0.2843-0.1036*s))))+edge*s;
    Point(first+i) = {x+c*s, y, z+c*h};
    If (i > 0 && i < 40 || i == 0 && edge > 0)
      Point(first+80-i) = {x+c*s, y, z-c*h};
    EndIf
  EndFor
  line = newl;
  Spline(line) = {first:first+40};
  loop = newll;
  If (edge > 0)
    Spline(line+1) = {first+40:first+80};
    Line(line+2) = {first+80, first};
    Curve Loop(loop) = {line, line+1, line+2};
  Else
    Spline(line+1) = {first+40:first+79, first};
    Curve Loop(loop) = {line, line+1};
  EndIf
Return
"""
#: A wing of span 4 on y = 0: chord 1 to 0.5, swept by 27 degrees, a blunt edge of 0.5 % of the chord.
SWEPT = SECTION + """edge = 0.0025;
x = 0; y = 0; z = 0; c = 1;
Call Section;
root = loop;
x = 2; y = 4; c = 0.5;
Call Section;
ThruSections(1) = {root, loop};
"""
#: Half a fuselage of 10 m that ends in a point, a wing with an edge 11 to 5 mm thick and a tailplane with a sharp one, in millimetres.
WING_BODY = SECTION + """nose = newp;
For i In {0:30}
  t = i/30;
  Point(nose+i) = {10000*t, 0, 2400*Sqrt(t)*(1-t)};
EndFor
profile = newl;
Spline(profile) = {nose:nose+30};
Line(profile+1) = {nose+30, nose};
half = newll;
Curve Loop(half) = {profile, profile+1};
section = news;
Plane Surface(section) = {half};
body[] = Extrude{{1, 0, 0}, {0, 0, 0}, 2*Pi}{ Surface{section}; };
edge = 0.0025; x = 2500; y = 0; z = -100; c = 2200;
Call Section;
root = loop;
x = 4500; y = 6000; c = 900;
Call Section;
wing = newv;
ThruSections(wing) = {root, loop};
edge = 0; x = 7800; y = 0; z = 100; c = 1100;
Call Section;
root = loop;
x = 8600; y = 1900; c = 600;
Call Section;
tail = newv;
ThruSections(tail) = {root, loop};
BooleanUnion{ Volume{body[1]}; Delete; }{ Volume{wing, tail}; Delete; }
"""
Case = collections.namedtuple("Case", "name geometry keys length reynolds angle streamlined")


def find(name):
    return next((str(path) for path in sorted(GEOMETRY.rglob(name)) if "reported" not in path.parts), None)


def half(extent=15):
    return {"farfield": {"shape": "hemisphere", "extent": extent, "symmetry": "y"}}


def cases():
    dlr_f6 = {"groups": {"symmetry": {"ids": [123], "type": "symmetry"}, "farfield": {"ids": ["124-128"], "type": "farfield"},
                         "aircraft": {"faces": "*", "type": "wall"}}}
    m6 = {"groups": {"symmetry": {"ids": [2], "type": "symmetry"}, "farfield": {"ids": ["0-1"], "type": "farfield"},
                     "wing": {"faces": "*", "type": "wall"}}}
    around = {"farfield": {"extent": 15}}
    return [
        Case("sphere", SPHERE, around, 2, 1e6, 0, False),
        Case("capsule", find("pyrefine_cev_capsule.igs"), around, 20, 1e6, 0, False),
        Case("oneram6", find("su2_oneram6.igs"), m6, 0.64607, 1.17e7, 0, True),
        Case("oneram6_3", find("su2_oneram6.igs"), m6, 0.64607, 1.17e7, 3, True),
        Case("dealii_wing", find("dealii_wing.igs"), around, 1, 1e6, 0, True),
        Case("d150_wing", find("tigl_D150_wing.igs"), around, 4000, 2e7, 0, True),
        Case("swept_wing", SWEPT, half(), 1, 3e6, 0, True),
        Case("half_transport", {"builtin": "transport"}, half(), 4, 2e7, 0, True),
        Case("half_d150", find("tigl_D150_fused_aircraft.brep"), half(), 4, 2e7, 0, True),
        Case("dlr_f6", find("gmsh_dlr_f6.brep"), dlr_f6, 141.2, 3e6, 0, True),
        Case("wing_fuselage", find("gmsh_wing_fuselage.step"), around, 1, 3e6, 0, True),
        Case("wing_body", WING_BODY, half(), 1700, 2e7, 0, True),
    ]


def geometry_of(case, folder):
    """The block `geometry`; text is that of a .geo file for gmsh."""
    if isinstance(case.geometry, dict):
        return case.geometry
    if not case.geometry.startswith("SetFactory"):
        return {"file": case.geometry}
    path = folder / "shape.brep"
    (folder / "shape.geo").write_text(case.geometry)
    subprocess.run(["gmsh", folder / "shape.geo", "-0", "-v", "2", "-o", path, "-format", "brep"], check=True)
    return {"file": str(path)}


def mesh(options, case, y_plus, folder):
    """Writes the case of the mesher and of the solver; False where that fails."""
    written = folder / "out" / "openfoam"
    if (folder / "out" / "report.json").exists() and written.exists():
        return json.loads((folder / "out" / "report.json").read_text())["exit_code"] == 0
    folder.mkdir(parents=True, exist_ok=True)
    layers = {"y_plus": y_plus, "reynolds": case.reynolds, "length": case.length}
    text = {"geometry": geometry_of(case, folder), **case.keys, "layers": layers,
            "sizing": {"target_tetrahedra": options.target, "solver": "cell"},
            "output": {"directory": str(folder / "out"), "formats": ["openfoam"], "parts": options.ranks, "pictures": False}}
    (folder / "case.yaml").write_text(json.dumps(text))
    with open(folder / "log.aeroloom", "w", encoding="utf-8") as log:
        return subprocess.run([options.program, "run", folder / "case.yaml"], stdout=log, stderr=log, check=False).returncode == 0


def solve(options, case, written):
    log = written / "log.simpleFoam"
    if log.exists() and ("\nEnd\n" in log.read_text() or "sigFpe" in log.read_text()):
        return
    written_case.set_iterations(written, options.iterations)
    if case.angle:
        written_case.turn_flow(written, case.angle)
    written_case.run(written)


def read_residuals(steps):
    """By field, the first initial residual of each step."""
    found = {}
    for name in ("Ux", "Uy", "Uz", "p"):
        found[name] = [float(match.group(1)) for match in
                       (re.search(rf"Solving for {name}, Initial residual = ([^,]+),", step) for step in steps) if match]
    return found


def fall_of(residuals):
    """By how much residuals fall from the largest one of the first ten to the last, the least of U and of p."""
    falls = [max(values[:10]) / max(values[-1], 1e-300) for values in residuals.values() if values]
    return min(falls, default=0)


def drift(values):
    """Between the means of the last two 50s, over the last."""
    if len(values) < 2 * LAST:
        return math.inf
    last, before = sum(values[-LAST:]) / LAST, sum(values[-2 * LAST:-LAST]) / LAST
    return abs(last - before) / max(abs(last), 1e-300)


def clipped(steps):
    """The lowest minimum of a turbulence that was clipped in the last 100 steps, over its average."""
    text = "".join(steps[-100:])
    found = re.findall(r"bounding (?:k|omega), min: (\S+) max: \S+ average: (\S+)", text)
    return min((float(low) / max(abs(float(mean)), 1e-300) for low, mean in found), default=0.0)


def judge(options, case, written):
    log = (written / "log.simpleFoam").read_text() if (written / "log.simpleFoam").exists() else ""
    steps = log.split("\nTime = ")[1:]
    forces = written_case.coefficients(written)
    drag, lift = forces.get("Cd", []), forces.get("Cl", [])
    fall, speed, low = fall_of(read_residuals(steps)), max(written_case.speeds(written, UNCOUNTED), default=math.nan), clipped(steps)
    drifts = [drift(drag)] + ([drift(lift)] if lift and drag and abs(lift[-1]) > abs(drag[-1]) else [])
    good = len(steps) == options.iterations and fall >= FALL and speed < FASTEST and low > -CLIPPED
    if case.streamlined:
        good = good and max(drifts) <= AGREEMENT
    cells = re.search(r"cells:\s+(\d+)", (written / "log.checkMesh").read_text()) if (written / "log.checkMesh").exists() else None
    cell_count = f"{int(cells.group(1)):,}" if cells else "–"
    if len(steps) < options.iterations:  # what a dying run says is nothing
        return False, (cell_count, f"dies, {len(steps)}", *["–"] * 6)
    return good, (cell_count, len(steps), f"{fall:.0f}", f"{speed:.2f}",
                  f"{drag[-1]:.5g}" if drag else "–", f"{lift[-1]:.5g}" if lift else "–", f"{100 * max(drifts):.2g}", f"{100 * low:.2g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default=ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--iterations", type=int, default=300)
    parser.add_argument("--target", type=int, default=100_000, help="tetrahedra, layers not counted")
    parser.add_argument("--only", nargs="*", help="names of cases")
    parser.add_argument("--y-plus", nargs="*", type=float, default=[1, 60])
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Cases that run", ["case", "y+", "cells", "iterations", "residuals fall by", "fastest, free streams", "drag", "lift",
                                            "drift of forces, %", "clipped, %", "good"])
    bad = 0
    for case in cases():
        for y_plus in options.y_plus:
            if options.only and case.name not in options.only or case.geometry is None:
                continue
            folder = options.folder.resolve() / f"{case.name}_{y_plus:g}"
            if not mesh(options, case, y_plus, folder):
                table.add(case.name, f"{y_plus:g}", "not meshed")
                bad += 1
                continue
            written = folder / "out" / "openfoam"
            solve(options, case, written)
            good, cells = judge(options, case, written)
            bad += not good
            table.add(case.name, f"{y_plus:g}", *cells, "yes" if good else "no")
    table.save(options.page)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
