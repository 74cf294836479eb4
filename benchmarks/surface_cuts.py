#!/usr/bin/env python3
"""The decomposition of CAD faces with and without simplification of the dual graph, as a Markdown table.

usage: surface_cuts.py SURFACE_BENCHMARK [FILE ...]

Without: METIS on the dual graph of the same background mesh, connected parts, nothing else (surface.cut_angle
0). Angles are those between fine edges where cuts end: on feature curves and where cuts meet.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
AIRCRAFT = ROOT.parent / "shared" / "geometry" / "aircraft"
FILES = ["gmsh_dlr_f6.brep", "tigl_D150_fused_aircraft.brep", "su2_oneram6.igs", "gmsh_wing_fuselage.step",
         "gmsh_submarine.stp", "dealii_wing.igs", "pyrefine_cev_capsule.igs"]


def run(program, file, angle, folder):
    config = folder / "case.yaml"
    config.write_text(f"geometry: {{file: {file}}}\nsurface: {{piece_triangles: 1500, cut_angle: {angle}}}\n")
    done = subprocess.run([program, config], capture_output=True, text=True)
    return dict(re.findall(r"(\w+)=(\S+)", done.stdout))


def main():
    program = sys.argv[1]
    files = [pathlib.Path(f) for f in sys.argv[2:]] or [ROOT / "configs/geometry/sphere.brep"] + [AIRCRAFT / f for f in FILES]
    print("| model | graph | pieces | angles < 10 | 10–20 | 20–30 | 30–40 | 40–50 | ≥ 50 | smallest | cut edges | imbalance | rounds |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for file in files:
            if not file.exists():
                continue
            for angle, name in ((0, "plain"), (40, "simplified")):
                r = run(program, file, angle, pathlib.Path(folder))
                if not r:
                    print(f"| {file.stem} | {name} | no mesh |")
                    continue
                print(f"| {file.stem} | {name} | {r['pieces']} | " + " | ".join(r["cut_angles_by_10"].split(",")) +
                      f" | {r['cut_angle_min']} | {r['cut_edges']} | {r['imbalance']} | {r['rounds']} |")


if __name__ == "__main__":
    main()
