#!/usr/bin/env python3
"""Groups of CAD faces: who is in which, on any number of ranks; sizes on a group within a fifth of what it asks for; names and
conditions in files for solvers.
usage: groups_test.py PROGRAM"""
import pathlib
import sys

import numpy
from program import COARSE_TRANSPORT, Run, SOURCE
from sources_test import edges_of, read

EXAMPLE = (SOURCE / "configs" / "groups.yaml").read_text().replace(
    "geometry/duct.step", f"'{SOURCE}/configs/geometry/duct.step'") + "  pictures: false\n  formats: [vtu, su2, openfoam]\n"
GROUPS = {"inlet": {0}, "outlet": {5, 9}, "branch": {7, 8}, "top": {2}, "walls": {1, 3, 4, 6}}
TYPES = {"inlet": "inlet", "outlet": "outlet", "branch": "wall", "top": "slip", "walls": "wall"}
WING = COARSE_TRANSPORT + """
groups:
  wing: {faces: 're:^wing_left_(upper|lower)$', size: 0.3}
  tip: {adjacent_to: wing, area: [0, 1], type: slip}
  canopy: {faces: 'canopy*', optional: true, size: 0.001}
output: {pictures: false}
"""


def faces_of(report):
    groups = {}
    for face in report["faces"]:
        groups.setdefault(face["group"], set()).add(face["id"])
    return groups


def median_edge(run, patch):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    surface = read(run.output / "surface.pvtp")
    number = [each["name"] for each in run.report["patches"]].index(patch)
    patches = vtk_to_numpy(surface.GetCellData().GetArray("patch"))
    return numpy.median(edges_of(surface, 3, patches == number)[0])


def check_example(program):
    """The example: groups by each condition, the same on several ranks; outputs carry names and conditions."""
    runs = [Run(program, EXAMPLE, ranks) for ranks in (1, 3)]
    for run in runs:
        assert run.code == 0, run.text
        assert faces_of(run.report) == GROUPS, faces_of(run.report)
    assert runs[0].report["mesh"]["hash"] == runs[1].report["mesh"]["hash"]
    report = runs[0].report
    patches = {patch["name"]: patch for patch in report["patches"]}
    assert {name: patch["type"] for name, patch in patches.items()} == TYPES
    for name, patch in patches.items():
        own = [face for face in report["faces"] if face["patch"] == name]
        assert sum(face["triangles"] for face in own) == patch["triangles"] and all(face["name"].startswith("face_") for face in own)
        assert abs(sum(face["area"] for face in own) - patch["area"]) < 1e-9
    su2 = (runs[0].output / "mesh.su2").read_text()
    assert all(f"MARKER_TAG= {name}" in su2 for name in GROUPS)
    boundary = next((runs[0].output / "mesh.openfoam").rglob("boundary"), None) if (runs[0].output / "mesh.openfoam").exists() else \
        next(runs[0].output.rglob("boundary"))
    assert all(name in boundary.read_text() for name in GROUPS)
    branch, walls = median_edge(runs[0], "branch"), median_edge(runs[0], "walls")
    print(f"branch: median edge {branch:.4f} where 0.06 is asked for; walls {walls:.4f}")
    assert 0.8 * 0.06 < branch < 1.2 * 0.06 < walls


def check_aircraft(program):
    """On bodies, by an expression, sizes hold and others stay."""
    run = Run(program, WING)
    assert run.code == 0, run.text
    wing = median_edge(run, "wing")
    print(f"wing: median edge {wing:.4f} where 0.3 is asked for")
    assert 0.8 * 0.3 < wing < 1.2 * 0.3
    groups = {face["name"]: face["group"] for face in run.report["faces"]}
    assert groups["wing_left_upper"] == groups["wing_left_lower"] == "wing" and groups["fuselage"] is None
    assert "tip" in groups.values() and "canopy" not in groups.values(), groups
    assert all(face["id"] is None for face in run.report["faces"] if face["patch"] == "farfield")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    check_example(program)
    check_aircraft(program)
    print("groups: ok")


if __name__ == "__main__":
    main()
