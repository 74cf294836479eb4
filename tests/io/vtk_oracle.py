#!/usr/bin/env python3
"""Lets VTK read the hand-made mesh (counts, volumes, names, directions), and reads meshes of meshio and Gmsh.

usage: vtk_oracle.py FIXTURE_PROGRAM
"""
import pathlib
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SQUARES = 4
PRISMS = 2 * SQUARES**2
PYRAMIDS = 5 * SQUARES
TETRAHEDRA = 3 * 2 * SQUARES**2 + 2 * SQUARES
HEXAHEDRA = SQUARES
# A slab of two layers, a row of cubes and one of hexahedra, under an affine map of this determinant.
DETERMINANT = numpy.linalg.det([[2, 0.25, 0], [0, 1.5, 0.125], [0.0625, 0, 1]])
VOLUMES = {10: (SQUARES**2 + SQUARES / 6) * DETERMINANT, 13: SQUARES**2 * DETERMINANT,
           14: SQUARES * 5 / 6 * DETERMINANT, 12: SQUARES * DETERMINANT}


def require(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def read_with_vtk(reader, path):
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    require(not problems, f"VTK complains of {path}")
    return reader.GetOutput()


def texts(data, name):
    array = data.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def check_volume(path):
    grid = read_with_vtk(vtk.vtkXMLPUnstructuredGridReader(), path)
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volume = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    for kind, count in ((10, TETRAHEDRA), (13, PRISMS), (14, PYRAMIDS), (12, HEXAHEDRA)):
        require((kinds == kind).sum() == count, f"{path}: {count} cells of type {kind}")
        require(volume[kinds == kind].min() > 0, f"{path}: cells of type {kind} have positive volume")
        require(abs(volume[kinds == kind].sum() - VOLUMES[kind]) < 1e-10, f"{path}: volume of type {kind}")
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    check_outward(surface.GetOutput(), volume.sum(), f"{path}: VTK's faces of cells")
    require(texts(grid, "region_names") == ["lower layer", "upper"], f"{path}: names of regions")
    require(texts(grid, "patch_names") == ["wing / lower side", "symmetry", "far field", "interface"],
            f"{path}: names of patches")
    require(texts(grid, "patch_types") == ["wall", "symmetry", "farfield", "interior"], f"{path}: types of patches")
    return grid, volume.sum()


def check_outward(surface, volume, what):
    """The surface encloses the volume with all normals outward."""
    points = vtk_to_numpy(surface.GetPoints().GetData())
    enclosed = 0.0
    for i in range(surface.GetNumberOfCells()):
        cell = surface.GetCell(i)
        corners = [points[cell.GetPointId(k)] for k in range(cell.GetNumberOfPoints())]
        for k in range(2, len(corners)):
            enclosed += numpy.dot(corners[0], numpy.cross(corners[k - 1], corners[k])) / 6
    require(abs(enclosed - volume) < 1e-9, f"{what} enclose {enclosed}, not {volume}")


def check_boundary(grid, surface):
    """The boundary in the field arrays is that of the surface file."""
    ids = vtk_to_numpy(grid.GetPointData().GetArray("global_id"))
    require(sorted(ids) == list(range(len(ids))), "global ids are those of all points")
    fields = {name: vtk_to_numpy(grid.GetFieldData().GetArray("boundary_" + name))
              for name in ("corners", "offsets", "patch")}
    in_volume = set()
    for face, patch in enumerate(fields["patch"]):
        if patch == 3:  # between regions
            continue
        in_volume.add((patch, tuple(fields["corners"][fields["offsets"][face]:fields["offsets"][face + 1]])))
    numbers = vtk_to_numpy(surface.GetPointData().GetArray("global_id"))
    patches = vtk_to_numpy(surface.GetCellData().GetArray("patch"))
    in_surface = set()
    for i in range(surface.GetNumberOfCells()):
        cell = surface.GetCell(i)
        in_surface.add((patches[i], tuple(numbers[cell.GetPointId(k)] for k in range(cell.GetNumberOfPoints()))))
    require(in_volume == in_surface and len(in_volume) > 0, "both files have the same boundary")


def read_here(path):
    """What our reader makes of a file, by line."""
    done = subprocess.run([sys.argv[1], "read", str(path)], capture_output=True, text=True)
    require(done.returncode == 0, f"{path}: {done.stderr}")
    return done.stdout.splitlines()


def check_meshio(folder, grid):
    """The cells of our file, as meshio writes them: binary and text, with a physical group per kind."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells, groups = {}, {}
    for name, kind, group in (("tetra", 10, 7), ("wedge", 13, 3), ("pyramid", 14, 3), ("hexahedron", 12, 3)):
        cells[name] = numpy.array([[grid.GetCell(i).GetPointId(k) for k in range(grid.GetCell(i).GetNumberOfPoints())]
                                   for i in range(grid.GetNumberOfCells()) if grid.GetCellType(i) == kind])
        if name == "wedge":  # meshio has Gmsh's order and turns it on writing
            cells[name] = cells[name][:, [0, 2, 1, 3, 5, 4]]
        groups[name] = numpy.full(len(cells[name]), group)
    mesh = meshio.Mesh(points, list(cells.items()), cell_data={"gmsh:physical": list(groups.values())})
    expected = [f"region volume_3: 0 {PYRAMIDS} {PRISMS} {HEXAHEDRA}", f"region volume_7: {TETRAHEDRA} 0 0 0"]
    for name, options in (("a.vtu", {"binary": True}), ("b.vtu", {"binary": False}),
                          ("c.vtu", {"compression": "lzma"}), ("d.vtk", {"binary": True}),
                          ("e.vtk", {"binary": False})):
        mesh.write(folder / name, **options)
        lines = read_here(folder / name)
        require(lines[0].startswith(f"points {len(points)} turned 0 "), f"{name} of meshio: {lines}")
        require(lines[1:3] == expected, f"{name} of meshio: {lines}")


def check_gmsh(folder):
    """Prisms on a disk; version 4.8 of Gmsh writes no numbers of entities to VTK files."""
    (folder / "prisms.geo").write_text("""SetFactory("OpenCASCADE");
        Disk(1) = {0, 0, 0, 1};
        Extrude {0, 0, 1} { Surface{1}; Layers{4}; Recombine; }
        Mesh.CharacteristicLengthMax = 0.4;
        Mesh.SaveAll = 1;""")
    for binary in ("0", "1"):
        done = subprocess.run(["gmsh", "-3", "-format", "vtk", "-setnumber", "Mesh.Binary", binary, "-o", "prisms.vtk",
                               "prisms.geo"], cwd=folder, capture_output=True, text=True)
        require(done.returncode == 0, done.stdout + done.stderr)
        lines = read_here(folder / "prisms.vtk")
        require(" turned 0 unnamed 0" in lines[0], f"prisms of Gmsh: {lines}")
        require(lines[1].startswith("region volume: 0 0 ") and len(lines) == 3, f"prisms of Gmsh: {lines}")
        require(lines[2].startswith("patch boundary: "), f"prisms of Gmsh: {lines}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], "write", name, str(SQUARES)], check=True)
        check_volume(folder / "packed.pvtu")
        grid, volume = check_volume(folder / "mesh.pvtu")
        surface = read_with_vtk(vtk.vtkXMLPPolyDataReader(), folder / "surface.pvtp")
        check_boundary(grid, surface)
        check_outward(surface, volume, "boundary faces")
        check_meshio(folder, grid)
        check_gmsh(folder)
    print("ok")


if __name__ == "__main__":
    main()
