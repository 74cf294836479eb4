#!/usr/bin/env python3
"""VTK opens what was written, and finds in it what the report says. usage: open_files_test.py PROGRAM"""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import vtk
from program import shared_run


def read(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def without_shared_memory(program, mesh):
    """A machine whose /dev/shm cannot be written: files are written all the same."""
    isolated = ["unshare", "--user", "--map-root-user", "--mount"] if os.getuid() else ["unshare", "--mount"]
    if subprocess.run([*isolated, "mount", "-t", "tmpfs", "-o", "ro", "tmpfs", "/dev/shm"], capture_output=True).returncode:
        print("no /dev/shm of its own can be had here")
        return
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "mesh.lb8.ugrid"
        command = f"mount -t tmpfs -o ro tmpfs /dev/shm && exec {shlex.quote(program)} convert {mesh} {file}"
        done = subprocess.run([*isolated, "sh", "-c", command], capture_output=True, text=True,
                              env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
        assert done.returncode == 0, done.stdout + done.stderr
        assert file.stat().st_size > 0


def main():
    run = shared_run(sys.argv[1])
    without_shared_memory(sys.argv[1], run.output / "mesh.pvtu")
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
