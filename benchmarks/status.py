#!/usr/bin/env python3
"""The first table of benchmarks/results/status.md: nine cases from CAD to improved mesh, on one rank.

usage: status.py PROGRAM [--arbiter CHECKER] [--cases CASE ...]

CHECKER is an independent checker of meshes, called as `CHECKER mesh.pvtu --surface surface.pvtp`. Needs the real CAD
files for all cases but the first.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = {
    "built-in transport in a box": "configs/transport.yaml",
    "DLR-F6 fluid volume": "configs/acceptance/spine_dlr_f6.yaml",
    "wing-body of two halves": "configs/acceptance/spine_wing_fuselage.yaml",
    "D150 half wing": "configs/acceptance/spine_d150_wing.yaml",
    "crew capsule": "configs/acceptance/spine_capsule.yaml",
    "half submarine": "configs/acceptance/spine_submarine.yaml",
    "D150 in a sphere of 10 lengths": "configs/acceptance/real_d150_sphere.yaml",
    "half D150 in a hemisphere of 100 lengths": "configs/acceptance/real_d150_half.yaml",
    "ONERA M6": "configs/acceptance/real_oneram6.yaml",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--arbiter")
    parser.add_argument("--cases", nargs="*", help="parts of names")
    options = parser.parse_args()
    print("| case | faces | triangles | tetrahedra | dihedral angles | least apart from CAD and features | mean ratio, average | wall s | valid |\n"
          + "|---" * 9 + "|")
    for name, case in CASES.items():
        if options.cases and not any(part in name for part in options.cases):
            continue
        with tempfile.TemporaryDirectory() as output:
            done = subprocess.run([options.program, "run", ROOT / case, "--set", f"output.directory={output}"], cwd=ROOT,
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0:
                print(f"| {name} (`{case}`) | exit {done.returncode} | | | | | | | |", flush=True)
                continue
            report = json.loads((pathlib.Path(output) / "report.json").read_text())
            valid = "–"
            if options.arbiter:
                said = subprocess.run([options.arbiter, f"{output}/mesh.pvtu", "--surface", f"{output}/surface.pvtp"],
                                      capture_output=True, text=True, check=False).stdout
                valid = "yes" if "VALID yes" in said else "NO"
        mesh, quality = report["mesh"], report["quality"]
        apart = report["improve"]["below_target"]["rest"]["smallest_dihedral_deg"]
        print(f"| {name} (`{case}`) | {report['geometry']['faces']} | {mesh['boundary_triangles']:,} | "
              f"{mesh['tetrahedra']:,} | {quality['min_dihedral_deg']:.1f} – {quality['max_dihedral_deg']:.1f} | "
              f"{'–' if apart is None else f'{apart:.1f}'} | "
              f"{quality['mean_mean_ratio']:.3f} | {report['wall_seconds']:.0f} | {valid} |", flush=True)


if __name__ == "__main__":
    main()
