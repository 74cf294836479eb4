#!/usr/bin/env python3
"""VTK opens what was written, and finds in it what the report says. usage: open_files_test.py PROGRAM"""
import sys

import vtk
from program import shared_run


def read(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def main():
    run = shared_run(sys.argv[1])
    mesh = read(vtk.vtkXMLPUnstructuredGridReader(), run.output / "mesh.pvtu")
    assert mesh.GetNumberOfCells() == run.report["mesh"]["tetrahedra"]
    assert {mesh.GetCellType(i) for i in range(0, mesh.GetNumberOfCells(), 97)} == {vtk.VTK_TETRA}
    assert mesh.GetPoints().GetDataType() == vtk.VTK_DOUBLE
    for array in ("piece", "mean_ratio", "min_dihedral"):
        assert mesh.GetCellData().GetArray(array), f"cell array {array} is missing"
    low, _ = mesh.GetCellData().GetArray("min_dihedral").GetRange()
    assert abs(low - run.report["quality"]["min_dihedral_deg"]) < 1e-3
    assert mesh.GetPointData().GetArray("global_id")

    surface = read(vtk.vtkXMLPPolyDataReader(), run.output / "surface.pvtp")
    assert surface.GetNumberOfCells() == run.report["mesh"]["boundary_triangles"]
    assert surface.GetCellData().GetArray("face") and surface.GetCellData().GetArray("patch")

    boundary = vtk.vtkGeometryFilter()
    boundary.SetInputData(mesh)
    boundary.Update()
    assert boundary.GetOutput().GetNumberOfCells() == surface.GetNumberOfCells(), "boundary and surface differ"
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(mesh)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    total = sum(volumes.GetValue(i) for i in range(volumes.GetNumberOfTuples()))
    assert abs(total - run.report["mesh"]["volume"]) < 1e-9 * total
    print("opened", mesh.GetNumberOfCells(), "tetrahedra and", surface.GetNumberOfCells(), "triangles")


if __name__ == "__main__":
    main()
