#!/usr/bin/env python3
"""Levels of the prediction workshops: what check forecasts for each of them, and the level that a budget takes. Growth and bounds are
given, so that fields are small.
usage: levels_test.py PROGRAM"""
import json
import pathlib
import subprocess
import sys
import tempfile

CASE = """
geometry: {builtin: transport}
farfield: {extent: 3, symmetry: y}
sizing: {level: A, solver: cell, growth: 3, curvature_angle: 60, surface_maximum: 1.5, maximum: 30}
"""
FACTORS = {"A": 1.5, "B": 1, "C": 2 / 3, "D": 0.5, "E": 1 / 3, "F": 2 / 9}


def check(program, *settings):
    with tempfile.TemporaryDirectory() as name:
        case = pathlib.Path(name) / "case.yaml"
        case.write_text(CASE)
        command = [program, "check", str(case), "--set", f"output.directory={name}/out"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
        record = pathlib.Path(name) / "out" / "check.json"
        return done, json.loads(record.read_text())["forecast"] if record.exists() else None


def main():
    program = sys.argv[1]
    done, forecast = check(program)
    assert done.returncode == 0, done.stderr
    assert "sizing: level A:" in done.stdout + done.stderr, done.stdout + done.stderr
    found = forecast["level"]
    edges = {edge["faces"]: edge for edge in found["trailing_edges"]}
    assert 16.9 < found["semispan"] < 17.1, found
    assert set(edges) == {"wing_right_trailing_edge", "horizontal_tail_right_trailing_edge"}, found
    wing = edges["wing_right_trailing_edge"]
    assert 14 < wing["length"] < 17.5 and 0 < wing["width"] < 0.1 and wing["shortest_chord"] < 2 < 5 < wing["longest_chord"], wing
    assert "wing_right_trailing_edge" in done.stdout and "semispan 17" in done.stdout, done.stdout
    levels = {row["level"]: row for row in forecast["levels"]}
    assert list(levels) == list(FACTORS), levels
    assert levels["A"]["tetrahedra"] == forecast["tetrahedra"] and levels["A"]["triangles"] == forecast["triangles"]
    for name, factor in FACTORS.items():
        finer = FACTORS["A"] / factor
        assert abs(levels[name]["tetrahedra"] / (forecast["tetrahedra"] * finer ** 3) - 1) < 0.02, levels
        assert abs(levels[name]["triangles"] / (forecast["triangles"] * finer ** 2) - 1) < 0.02, levels

    # A budget between that level and a finer one, which is asked for; and one that holds none.
    done, within = check(program, "sizing.level=B", f"sizing.budget={1.3 * forecast['tetrahedra']:.0f}")
    assert done.returncode == 0 and "sizing: level A:" in done.stdout + done.stderr, done.stdout + done.stderr
    assert (within["tetrahedra"], within["triangles"]) == (forecast["tetrahedra"], forecast["triangles"]), within
    done, none = check(program, f"sizing.budget={0.5 * forecast['tetrahedra']:.0f}")
    assert done.returncode != 0 and none is None and "do not hold level A" in done.stderr, done.stderr
    print("levels: forecasts by the cube, the level that a budget holds")


if __name__ == "__main__":
    main()
