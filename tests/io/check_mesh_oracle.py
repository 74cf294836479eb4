#!/usr/bin/env python3
"""Our measures of faces and cells against those of checkMesh, digit by digit: meshes of all shapes whose points are moved, so that
quadrilaterals are warped, and flattened ones, with severe angles, skewness and aspect ratios.

usage: check_mesh_oracle.py WRITE_GMSH_OPENFOAM AEROLOOM
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MESHES = ("moved", "flat")
DIGITS = 1e-9  # checkMesh prints twelve digits


def run(command, folder):
    environment = os.environ | {"PWD": str(folder), "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"),
                                "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=100)
    assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
    return result.stdout


def printed(text, pattern):
    """What is in the groups of a pattern; zeros where a line is left out, as those of counts are."""
    found = re.search(pattern, text)
    groups = re.compile(pattern).groups
    return [float(value) for value in found.groups()] if found else [0.0] * groups


def of_check_mesh(case):
    text = run(["checkMesh", "-allGeometry"], case)
    number = r"(-?[0-9.e+-]*[0-9])"
    largest, average = printed(text, rf"Mesh non-orthogonality Max: {number} average: {number}")
    severe, = printed(text, r"Number of severely non-orthogonal \(> 70 degrees\) faces: (\d+)")
    wrong, = printed(text, r"Number of non-orthogonality errors: (\d+)")
    smallest, mean = printed(text, rf"Cell determinant \(wellposedness\) : minimum: {number} average: {number}")
    ratio, mean_ratio = printed(text, rf"Face volume ratio : minimum: {number} average: {number}")
    return {
        "non_orthogonality/largest_deg": largest, "non_orthogonality/average_deg": average,
        "non_orthogonality/above_70_deg": severe + wrong,
        "skewness/largest": printed(text, rf"Max skewness = {number}")[0],
        "skewness/above_4": printed(text, r"(\d+) highly skew faces")[0],
        "aspect_ratio/largest": printed(text, rf"Max aspect ratio(?: =|:) {number}")[0],
        "aspect_ratio/above_1000": printed(text, r"High aspect ratio cells found.* number of cells (\d+)")[0],
        "determinant/smallest": smallest, "determinant/mean": mean,
        "determinant/below_0.001": printed(text, r"small determinant \(< 0.001\) found, number of cells: (\d+)")[0],
        "volume_ratio/smallest": ratio, "volume_ratio/mean": mean_ratio,
    }


def of_us(program, mesh):
    solver = json.loads(run([program, "quality", mesh.name, "--json"], mesh.parent))["solver"]
    faces = solver["faces"].values()
    assert sum(of["faces"] for of in faces) == solver["inner_faces"], solver
    assert max(of["largest_deg"] for of in faces) == solver["non_orthogonality"]["largest_deg"], solver
    return {f"{name}/{key}": value for name in ("non_orthogonality", "skewness", "aspect_ratio", "determinant", "volume_ratio")
            for key, value in solver[name].items()}


def main(writer, program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run([writer, str(folder)], folder)
        for mesh in MESHES:
            theirs, ours = of_check_mesh(folder / mesh), of_us(program, folder / f"{mesh}.msh")
            assert theirs.keys() == ours.keys(), (theirs, ours)
            for key, value in theirs.items():
                print(f"{mesh:<8}{key:<32}{value:>18.12g}{ours[key]:>18.12g}")
                assert abs(ours[key] - value) <= DIGITS * max(abs(value), 1e-3), f"{mesh}: {key}: {value}, ours {ours[key]}"
        assert theirs["skewness/above_4"] > 0 and theirs["non_orthogonality/above_70_deg"] > 0, theirs


if __name__ == "__main__":
    if shutil.which("checkMesh") is None:
        sys.exit(77)
    main(sys.argv[1], sys.argv[2])
