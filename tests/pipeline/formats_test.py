#!/usr/bin/env python3
"""All formats of solvers from one run of the built-in aircraft: what readers nobody here wrote make of them.
usage: formats_test.py PROGRAM"""
import sys

from program import COARSE_TRANSPORT, NO_PICTURES, Run
from solver_files import CHECKS

AIRCRAFT = COARSE_TRANSPORT.replace("minimum: 0.5", "minimum: 1").replace("angle: 30", "angle: 45") + """
volume: {piece_tets: 10000}
patches:
  wing: {faces: ['wing_*'], type: slip}
  fins: {faces: ['horizontal_*', 'vertical_*']}
""" + NO_PICTURES


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
