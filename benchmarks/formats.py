#!/usr/bin/env python3
"""The formats of solvers at a million tetrahedra: bytes, seconds, memory of the ranks that write, and what other
readers make of them.

usage: formats.py PROGRAM [--case configs/acceptance/whole_transport.yaml] [--ranks 1 2 8] [--skip-checks]

Prints the table of benchmarks/results/formats.md. Memory is the largest rank's own at the end of the stage before, and the most it had while
writing: the difference is what a format takes on top of a rank's share of the mesh.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests" / "pipeline"))
from solver_files import CHECKS  # noqa: E402


def run(program, case, ranks, form, folder):
    command = [SOURCE / "scripts" / "mpirun_local.sh", ranks, program, "run", case, "--set", f"output.directory={folder}",
               "--set", f"output.formats=[{form}]", "--set", "output.parts=8"]
    subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, timeout=900)
    return json.loads((folder / "report.json").read_text())


def file_bytes(folder):
    return sum(path.stat().st_size for path in folder.rglob("*")
               if path.is_file() and path.name != "report.json" and not str(path.relative_to(folder)).startswith("surface"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--case", default=SOURCE / "configs" / "acceptance" / "whole_transport.yaml")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 8])
    parser.add_argument("--formats", nargs="+", default=list(CHECKS))
    parser.add_argument("--skip-checks", action="store_true")
    arguments = parser.parse_args()
    heads = [f"{n} rank(s): s, MiB" for n in arguments.ranks]
    print("| format | MiB in files | " + " | ".join(heads) + " | checked |\n" + "|---" * (len(heads) + 3) + "|")
    for form in arguments.formats:
        cells, seen = [], ""
        for ranks in arguments.ranks:
            with tempfile.TemporaryDirectory(prefix="aeroloom_formats_") as name:
                folder = pathlib.Path(name)
                report = run(arguments.program, arguments.case, ranks, form, folder)
                stages = {stage["name"]: stage for stage in report["stages"]}
                before, output = stages["inspect"], stages["output"]
                cells.append(f"{output['wall_seconds']:.2f}, {before['peak_own_bytes_max'] / 2**20:.0f} -> "
                             f"{output['peak_own_bytes_max'] / 2**20:.0f}")
                if ranks == arguments.ranks[-1]:
                    size = file_bytes(folder) / 2**20
                    seen = "-" if arguments.skip_checks else CHECKS[form](folder, report)
        print(f"| {form} | {size:.0f} | " + " | ".join(cells) + f" | {seen} |", flush=True)


if __name__ == "__main__":
    main()
