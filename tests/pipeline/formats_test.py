#!/usr/bin/env python3
"""All formats of solvers from one run of the built-in aircraft: what readers nobody here wrote make of them.
usage: formats_test.py PROGRAM"""
import sys

from program import Run
from solver_files import CHECKS

AIRCRAFT = """
geometry: {builtin: transport, trailing_edges: sharpen}
farfield: {shape: box, extent: 3}
sizing: {target_tetrahedra: 20000, feature_budget: 1, proximity: 0, curvature_angle: 30, growth: 1.5}
volume: {piece_tets: 20000}
patches:
  wing: {faces: ['wing_*'], type: slip}
  fins: {faces: ['horizontal_*', 'vertical_*']}
"""


def main():
    formats = "output.formats=[" + ",".join(CHECKS) + "]"
    run = Run(sys.argv[1], AIRCRAFT, 2, (formats, "output.parts=2"))
    assert run.code == 0, run.text
    types = {patch["name"]: patch["type"] for patch in run.report["patches"]}
    assert types == {"farfield": "farfield", "fuselage": "wall", "wing": "slip", "fins": "wall"}, types
    for name, check in CHECKS.items():
        try:
            print(f"{name}: {check(run.output, run.report)}")
        except AssertionError as error:
            raise AssertionError(f"{name}: {error}") from error


if __name__ == "__main__":
    main()
