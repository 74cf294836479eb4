#!/usr/bin/env python3
"""The angles of interfaces with and without simplification of the dual graph, as a Markdown table.

usage: interface_angles.py PROGRAM [FILE ...]

Without: METIS on the dual graph of the same background tetrahedra, connected parts, nothing else
(volume.interface_angle 0). Angles are those between fine triangles where interfaces meet each other and the
boundary, the smallest one around each edge; sizes from the model, pieces of 50,000 tetrahedra.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
AIRCRAFT = ROOT.parent / "shared" / "geometry" / "aircraft"
CAD = {".brep", ".step", ".stp", ".igs", ".iges"}


def run(program, file, angle, folder):
    settings = [f"volume.interface_angle={angle}", "volume.piece_tets=50000", "volume.erase_interfaces=false",
                "improve.enabled=false", f"output.directory={folder}"]
    config = pathlib.Path(folder) / "case.yaml"
    config.write_text(f"geometry: {{file: {file}}}\n")
    command = [program, "run", str(config)]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    report = pathlib.Path(folder) / "report.json"
    return json.loads(report.read_text()) if done.returncode == 0 else None


def main():
    program = sys.argv[1]
    files = [pathlib.Path(f) for f in sys.argv[2:]] or sorted(f for f in AIRCRAFT.glob("*") if f.suffix in CAD)
    print("| model | graph | pieces | merged | edges | < 10 | 10–20 | 20–30 | 30–40 | ≥ 40 | below 35 | forced | smallest "
          "| interface triangles | heaviest / mean |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    for file in files:
        for angle, name in ((0, "plain"), (45, "simplified")):
            with tempfile.TemporaryDirectory() as folder:
                report = run(program, file, angle, folder)
            if report is None:
                print(f"| {file.stem} | {name} | no mesh |", flush=True)
                continue
            angles, plan, volume = report["volume"]["interface_angles"], report["decompose"], report["volume"]
            bins = angles["counts_by_10_deg"]
            print(f"| {file.stem} | {name} | {plan['pieces']} | {len(volume['merges'])} | {angles['edges']:,} | "
                  + " | ".join(str(b) for b in bins[:4]) + f" | {sum(bins[4:]):,} | {angles['below_35_deg']} | {angles['forced']} "
                  f"| {angles['smallest_deg'] or 0:.1f} | {plan['interface_triangles']:,} | {plan['imbalance']:.2f} |", flush=True)


if __name__ == "__main__":
    main()
