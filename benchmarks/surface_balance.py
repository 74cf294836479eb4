#!/usr/bin/env python3
"""The surface stage over rank counts with both schemes, one task per CAD face and pieces, as a Markdown table.

usage: surface_balance.py SURFACE_BENCHMARK [CASE ...]

Cases are files; those of configs/acceptance where none is given. Figures are CPU time of the tasks, so ranks may
share cores. Serial is work of one rank alone, and work repeated on all of them, over the stage's total.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ["configs/acceptance/surface_sphere.yaml", "configs/acceptance/surface_dlr_f6.yaml"]
RANKS = (1, 2, 4, 8, 16)


def run(program, case, scheme, ranks):
    command = [ROOT / "scripts/mpirun_local.sh", str(ranks), program, case, f"surface.decomposition={scheme}"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    return dict(re.findall(r"(\w+)=(\S+)", done.stdout))


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    print("| case | scheme | ranks | pieces | triangles | CPU s | busiest CPU s | busiest / mean | serial | 90 % of loads within | hash |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for case in sys.argv[2:] or CASES:
        for scheme in ("faces", "pieces"):
            for ranks in RANKS:
                r = run(program, case, scheme, ranks)
                if not r:
                    print(f"| {pathlib.Path(case).stem} | {scheme} | {ranks} | failed |")
                    continue
                print(f"| {pathlib.Path(case).stem.removeprefix('surface_')} | {scheme} | {ranks} | {r['pieces']} | "
                      f"{int(r['triangles']):,} | {r['cpu_total']} | {r['cpu_max']} | {r['busiest']} | "
                      f"{100 * float(r['serial_share']):.1f} % | {100 * float(r['load_error_90']):.0f} % | {r['hash'][:8]} |",
                      flush=True)


if __name__ == "__main__":
    main()
