#!/usr/bin/env python3
"""Files in HDF5 as others read them: VTK's own reader, cgnscheck, h5py; and one HDF5 library in the program.

usage: hdf5_oracle.py WRITER MPIRUN PROGRAM
"""
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

SQUARES, PARTS = 4, 3
# Of the mixed mesh (mixed_mesh.hpp): two slabs, a row of cubes and one of hexahedra under an affine map.
VOLUME = (2 * SQUARES**2 + 2 * SQUARES) * np.linalg.det(
    np.array([[2, 0.25, 0], [0, 1.5, 0.125], [0.0625, 0, 1]]))
CELLS = {vtk.VTK_WEDGE: 2 * SQUARES**2, vtk.VTK_PYRAMID: 5 * SQUARES, vtk.VTK_TETRA: 6 * SQUARES**2 + 2 * SQUARES,
         vtk.VTK_HEXAHEDRON: SQUARES}


def write(writer, mpirun, ranks, kind, folder):
    folder.mkdir(exist_ok=True)
    subprocess.run([mpirun, str(ranks), writer, kind, folder, str(SQUARES), str(PARTS)], check=True)


def read_vtk(path, piece=0, pieces=1):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.UpdatePiece(piece, pieces, 0)
    grid = vtk.vtkUnstructuredGrid()
    grid.DeepCopy(reader.GetOutput())
    return grid


def sizes(grid):
    filter_ = vtk.vtkCellSizeFilter()
    filter_.SetInputData(grid)
    filter_.Update()
    data = filter_.GetOutput().GetCellData()
    return vtk_to_numpy(data.GetArray("Volume")), vtk_to_numpy(data.GetArray("Area"))


def texts(grid, name):
    array = grid.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def check_volume(folder):
    grid = read_vtk(folder / "mesh.vtkhdf")
    types = [grid.GetCellType(c) for c in range(grid.GetNumberOfCells())]
    assert {t: types.count(t) for t in set(types)} == CELLS, types
    volumes, _ = sizes(grid)
    assert (volumes > 0).all() and math.isclose(volumes.sum(), VOLUME, rel_tol=1e-12), volumes.sum()
    assert texts(grid, "region_names") == ["lower layer", "upper"]
    region = vtk_to_numpy(grid.GetCellData().GetArray("region"))
    assert math.isclose(volumes[region == 1].sum() / VOLUME, SQUARES / (2 * SQUARES + 2), rel_tol=1e-12)
    part = vtk_to_numpy(grid.GetCellData().GetArray("part"))
    # Every number from 0 on is one point, whatever the partitions that know it.
    numbers = vtk_to_numpy(grid.GetPointData().GetArray("global_id"))
    places = vtk_to_numpy(grid.GetPoints().GetData())
    assert set(numbers) == set(range(numbers.max() + 1))
    for number in set(numbers):
        assert len(np.unique(places[numbers == number], axis=0)) == 1
    # A partition at a time, as parallel viewers read.
    pieces = [read_vtk(folder / "mesh.vtkhdf", p, PARTS) for p in range(PARTS)]
    for p, piece in enumerate(pieces):
        assert set(vtk_to_numpy(piece.GetCellData().GetArray("part"))) == {p}
        assert piece.GetNumberOfCells() == (part == p).sum() > 0
    return grid


def outer_area(grid):
    """Of the skin of the grid, its points merged by their numbers."""
    numbers = vtk_to_numpy(grid.GetPointData().GetArray("global_id"))
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for number in range(numbers.max() + 1):
        points.InsertNextPoint(grid.GetPoint(int(np.argmax(numbers == number))))
    merged = vtk.vtkUnstructuredGrid()
    merged.SetPoints(points)
    for c in range(grid.GetNumberOfCells()):
        corners = grid.GetCell(c).GetPointIds()
        ids = [int(numbers[corners.GetId(k)]) for k in range(corners.GetNumberOfIds())]
        merged.InsertNextCell(grid.GetCellType(c), len(ids), ids)
    skin = vtk.vtkGeometryFilter()
    skin.SetInputData(merged)
    skin.Update()
    return sizes(skin.GetOutput())[1].sum()


def check_surface(folder, grid):
    surface = read_vtk(folder / "surface.vtkhdf")
    names, kinds = texts(surface, "patch_names"), texts(surface, "patch_types")
    assert names == ["wing / lower side", "symmetry", "far field", "interface"], names
    assert kinds == ["wall", "symmetry", "farfield", "interior"], kinds
    _, areas = sizes(surface)
    patch = vtk_to_numpy(surface.GetCellData().GetArray("patch"))
    assert math.isclose(areas[patch < 3].sum(), outer_area(grid), rel_tol=1e-9)
    with h5py.File(folder / "mesh.vtkhdf") as file:
        check_boundary_group(file, grid, names, kinds, areas, patch)


def check_boundary_group(file, grid, names, kinds, areas, patch):
    group = file["Boundary"]
    assert [n.decode() for n in group["PatchNames"]] == names
    assert [n.decode() for n in group["PatchTypes"]] == kinds
    offsets, corners = group["Offsets"][:], group["Connectivity"][:]
    assert offsets[0] == 0 and offsets[-1] == len(corners) and len(offsets) == len(areas) + 1
    assert (group["Patch"][:] == patch).all()
    place = dict(zip(vtk_to_numpy(grid.GetPointData().GetArray("global_id")),
                     vtk_to_numpy(grid.GetPoints().GetData())))
    enclosed = 0
    for f, kind in enumerate(group["Types"][:]):
        points = [place[c] for c in corners[offsets[f]:offsets[f + 1]]]
        assert len(points) == {5: 3, 9: 4}[kind]
        if patch[f] == 3:
            continue
        for k in range(1, len(points) - 1):
            enclosed += np.dot(np.cross(points[0], points[k]), points[k + 1]) / 6
    assert math.isclose(enclosed, VOLUME, rel_tol=1e-12), (enclosed, VOLUME)  # outward


def run_cgnscheck(folder):
    result = subprocess.run(["cgnscheck", "-v", folder / "mesh.cgns"], capture_output=True, text=True, check=True)
    assert "checking complete" in result.stdout, result.stdout
    for word in ("ERROR", "WARNING", "warnings", "errors"):
        assert word not in result.stdout + result.stderr, result.stdout
    return result.stdout


def check_cgns(folder):
    told = run_cgnscheck(folder)
    for line in ("Vertex Size=[99]", f"Cell Size=[{sum(CELLS.values())}]", 'Family="far field"',
                 "[internal,external] Faces=[0,", "Element Set Type=PENTA_6", "Element Set Type=PYRA_5",
                 "Element Set Type=HEXA_8"):
        assert line in told, line
    assert "Faces=[0,0]" not in told, "a boundary section without faces on the outside"


def check_names(folder):
    """Names that are hard to hold: all of them can be had back, and none stands twice."""
    grid, surface = read_vtk(folder / "mesh.vtkhdf"), read_vtk(folder / "surface.vtkhdf")
    long_name = "Größe einer Oberfläche, die nicht in den Knoten passt"
    assert texts(grid, "region_names") == ["inner/outer", "ZoneBC"]
    assert texts(surface, "patch_names") == ["ZoneBC", long_name, "", "interface"]
    with h5py.File(folder / "mesh.cgns") as file:
        zone, base = file["Base/Zone"], file["Base"]
        sections = [name for name in zone if zone[name].attrs.get("label") == b"Elements_t"]
        families = [name for name in base if base[name].attrs.get("label") == b"Family_t"]
        assert set(families) == set(zone["ZoneBC"]) - {" data"} and len(families) == 3, families
        assert "ZoneBC_2" in families and "Patch" in families, families
        for name in sections + families:
            assert 0 < len(name.encode()) <= 32, name
        full = [bytes(base[name]["FullName/ data"][:]).decode() for name in families if "FullName" in base[name]]
        assert sorted(full) == [long_name, "ZoneBC"], full
        full = {bytes(zone[name]["FullName/ data"][:]).decode() for name in sections if "FullName" in zone[name]}
        assert full == {"inner/outer", "ZoneBC"}, full
    if shutil.which("cgnscheck"):
        run_cgnscheck(folder)


def check_libraries(program):
    """One build of HDF5, never the serial one beside it."""
    listed = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    found = {line.split()[0] for line in listed.splitlines() if "libhdf5" in line}
    assert len(found) == 1 and "serial" not in found.pop(), listed


def main():
    writer, mpirun, program = sys.argv[1:4]
    check_libraries(writer)
    check_libraries(program)
    folders = []
    with tempfile.TemporaryDirectory() as name:
        for ranks in (1, 3):
            folder = pathlib.Path(name) / str(ranks)
            for kind in ("vtkhdf", "cgns"):
                write(writer, mpirun, ranks, kind, folder)
            folders.append(folder)
        for file in folders[0].iterdir():
            assert file.read_bytes() == (folders[1] / file.name).read_bytes(), file.name
        grid = check_volume(folders[1])
        check_surface(folders[1], grid)
        if shutil.which("cgnscheck"):
            check_cgns(folders[1])
        write(writer, mpirun, 2, "names", pathlib.Path(name) / "names")
        check_names(pathlib.Path(name) / "names")
    print("files in HDF5: as others read them, good")


if __name__ == "__main__":
    main()
