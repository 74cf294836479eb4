#!/usr/bin/env python3
"""CAD with one small mistake ends in a mesh or in a message with a place. usage: mutations_test.py PROGRAM MUTATE_CAD"""
import pathlib
import re
import subprocess
import sys
import tempfile

from program import SOURCE, Run

# Every kind of mistake once, and the sliver twice.
SEEDS = (0, 1, 2, 3, 4, 8)

# A second. Mutated files are in millimetres.
CASE = """
geometry: {{file: "{file}", trailing_edges: sharpen}}
farfield: {{shape: box, extent: 3}}
sizing: {{minimum: 500, feature_minimum: 500, maximum: 10000, surface_maximum: 2000, curvature_angle: 40, growth: 1.9, proximity: 0}}
output: {{pictures: false}}
"""


def main():
    program, mutate = sys.argv[1:3]
    strips = 0
    for seed in SEEDS:
        with tempfile.TemporaryDirectory(prefix="aeroloom_test_") as name:
            file = pathlib.Path(name) / ("mutated.brep" if seed % 5 == 4 else "mutated.step")
            done = subprocess.run([mutate, SOURCE / "tests/data/wing_body.step", str(seed), file], capture_output=True, text=True,
                                  timeout=60, check=True)
            run = Run(program, CASE.format(file=file), seconds=120, folder=name)
            said = f"seed {seed}, {done.stdout.strip()}: {run.text}"
            if run.code == 0:
                zones = [retry["zone"] for retry in run.report["volume"]["retries"]]
                assert len(zones) == len(set(zones)), said
                strips += sum("below the noise" in change["what"] for change in run.report["geometry"]["changes"])
            else:
                assert run.code > 0 and re.search(r"error: .*\([-\d.e+]+, [-\d.e+]+, [-\d.e+]+\)", run.text), said
    assert strips >= 2, strips  # the slivers of seeds 3 and 8


if __name__ == "__main__":
    main()
