#!/usr/bin/env python3
"""Boundary layers from the case to the files: prisms on walls, the same mesh on any number of ranks and after a resumed run, the
surface as it is without layers, rows of the report. usage: layers_test.py PROGRAM"""
import collections
import json
import sys

import jsonschema
import numpy
import vtk
from vtkmodules.util.numpy_support import vtk_to_numpy

from program import SOURCE, Run

SPHERE = f"""
geometry: {{file: "{SOURCE}/configs/geometry/sphere.brep"}}
farfield: {{shape: box, extent: 2}}
sizing: {{target_tetrahedra: 6000}}
surface: {{piece_triangles: 300}}
volume: {{piece_tets: 3000}}
"""
LAYERS = "layers: {first: 1e-3, growth: 1.5}\n"
SCHEMA = json.loads((SOURCE / "docs" / "report.schema.json").read_text())


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def check_files(run, bare):
    """Cells and layers as the report counts them; the surface is that of a run without layers."""
    grid = read(vtk.vtkXMLPUnstructuredGridReader(), run.output / "mesh.pvtu")
    layer = vtk_to_numpy(grid.GetCellData().GetArray("layer"))
    types = collections.Counter(grid.GetCellType(c) for c in range(grid.GetNumberOfCells()))
    mesh, row = run.report["mesh"], run.report["layers"]["patches"][0]
    assert types[vtk.VTK_WEDGE] == mesh["prisms"] == row["prisms"] > 1000, (types, mesh, row)
    assert types[vtk.VTK_PYRAMID] == mesh["pyramids"] == row["pyramids"], (types, mesh, row)
    assert types[vtk.VTK_TETRA] == mesh["tetrahedra"], (types, mesh)
    assert mesh["layer_tetrahedra"] == row["tetrahedra"] > 0
    page = (run.output / "report.html").read_text()
    assert "off the boundary layers" in page and "without boundary layers" not in page
    assert numpy.count_nonzero(layer) == row["prisms"] + row["pyramids"] + row["tetrahedra"]
    assert layer.max() == row["layers_max"] > 5 and layer.min() == 0
    surfaces = [read(vtk.vtkXMLPPolyDataReader(), r.output / "surface.pvtp") for r in (run, Run(*bare))]
    points = [vtk_to_numpy(s.GetPoints().GetData()) for s in surfaces]
    # Improvement moves vertices of a boundary that has no layers, if few of them.
    assert surfaces[0].GetNumberOfCells() <= mesh["boundary_triangles"] + mesh["boundary_quadrilaterals"]
    assert points[0].shape[1] == 3 and abs(len(points[0]) - len(points[1])) < 0.02 * len(points[1])


def check_report(report):
    errors = [e.message for e in jsonschema.Draft202012Validator(SCHEMA).iter_errors(report)]
    assert not errors, errors
    row, = report["layers"]["patches"]
    assert row["first"] == 1e-3 and row["growth"] == 1.5 and row["count"] is None
    assert row["full"] > 0.95 and report["layers"]["empty"] == 0, report["layers"]
    assert [s["name"] for s in report["stages"]] == ["start", "geometry", "sizing", "surface", "layers", "decompose", "volume",
                                                     "improve", "inspect", "output"]
    # The flat cells at the wall do not count.
    assert report["quality"]["min_dihedral_deg"] > 5, report["quality"]["min_dihedral_deg"]


def check_resumed(program, folder, wanted):
    for checkpoints in ("write", "resume"):
        run = Run(program, SPHERE + LAYERS, 2, (f"output.checkpoints={checkpoints}",), folder=folder)
        assert run.code == 0 and run.report["mesh"]["hash"] == wanted, run.text
    assert run.report["resumed"] == ["geometry", "sizing", "surface", "volume", "improve"], run.report["resumed"]
    other = Run(program, SPHERE + LAYERS, 2, ("output.checkpoints=resume", "layers.growth=1.4"), folder=folder)
    assert other.code == 0 and other.report["resumed"] == ["geometry", "sizing", "surface"], other.report["resumed"]
    assert other.report["mesh"]["hash"] != wanted


def check_plane(program):
    """Layers end on a plane of symmetry: in its quadrilaterals, exactly planar; the rest of it is meshed again."""
    half = SPHERE.replace("extent: 2", "extent: 2, symmetry: y") + LAYERS
    runs = [Run(program, half, ranks) for ranks in (1, 3)]
    assert all(run.code == 0 for run in runs), [run.text for run in runs]
    mesh = runs[0].report["mesh"]
    assert mesh["hash"] == runs[1].report["mesh"]["hash"], "the mesh depends on the number of ranks"
    assert mesh["boundary_quadrilaterals"] > 100 and runs[0].report["layers"]["full"] > 0.95, runs[0].report["layers"]
    surface = read(vtk.vtkXMLPPolyDataReader(), runs[0].output / "surface.pvtp")
    points = vtk_to_numpy(surface.GetPoints().GetData())
    ids = vtk.vtkIdList()
    quads = 0
    for cell in range(surface.GetNumberOfCells()):
        surface.GetCellPoints(cell, ids)
        if ids.GetNumberOfIds() == 4:
            quads += 1
            assert all(points[ids.GetId(k)][1] == 0 for k in range(4)), "a layer leaves the plane"
    assert quads == mesh["boundary_quadrilaterals"]
    assert surface.GetNumberOfCells() == quads + mesh["boundary_triangles"]


def main():
    program = sys.argv[1]
    check_plane(program)
    runs = {ranks: Run(program, SPHERE + LAYERS, ranks) for ranks in (1, 2, 3)}
    for ranks, run in runs.items():
        assert run.code == 0, f"{ranks} ranks ended with {run.code}:\n{run.text}"
    hashes = {run.report["mesh"]["hash"] for run in runs.values()}
    print(hashes, {ranks: round(run.seconds, 1) for ranks, run in runs.items()})
    assert len(hashes) == 1, "the mesh depends on the number of ranks"
    check_report(runs[1].report)
    check_files(runs[2], (program, SPHERE))
    check_resumed(program, runs[3].folder, *hashes)
    wrong = Run(program, SPHERE + "layers: {first: 1e-3, patches: {no_such_patch: {count: 3}}}\n")
    assert wrong.code == 2 and "layers.patches.no_such_patch: there is no such patch" in wrong.text, wrong.text


if __name__ == "__main__":
    main()
