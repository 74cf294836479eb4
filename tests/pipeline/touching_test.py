#!/usr/bin/env python3
"""Faces that touch, nearly do, or cross end in a message with both names, soon. usage: touching_test.py PROGRAM TOUCHING"""
import pathlib
import re
import subprocess
import sys
import tempfile

from program import Run

CASE = """
geometry: {{file: "{file}"}}
sizing: {{target_tetrahedra: 2000, proximity: 0}}
output: {{pictures: false}}
"""
# Kind, distance and what is said; the block is 4 long.
BODIES = [("lid", "0", "lie on one another"), ("lid", "1e-6", "lie on one another"), ("lid", "4e-5", "lie on one another"),
          ("slot", "4e-9", "lie on one another"), ("crack", "0", "lie on one another"),
          # Rounds that would part them end early, before they take what is allowed.
          ("crossing", "0", "are allowed")]


def main():
    program, touching = sys.argv[1:3]
    for kind, apart, said in BODIES:
        with tempfile.TemporaryDirectory(prefix="aeroloom_test_") as name:
            file = pathlib.Path(name) / "body.step"
            subprocess.run([touching, kind, file, apart], capture_output=True, timeout=60, check=True)
            run = Run(program, CASE.format(file=file), seconds=60, folder=name)
            text = f"{kind} {apart}, code {run.code}: {run.text}"
            error = next((line for line in run.text.splitlines() if line.startswith("error")), "")
            assert run.code > 0 and said in error, text
            assert len(set(re.findall(r"'(face_\d+)'", error))) >= 2, text
            assert re.search(r"\([-\d.e+]+, [-\d.e+]+, [-\d.e+]+\)", error), text
            if kind == "crossing":
                assert run.code == 4, text


if __name__ == "__main__":
    main()
