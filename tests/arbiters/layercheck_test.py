#!/usr/bin/env python3
"""What the independent arbiter says of meshes with layers: of fans, of layers that end on curved faces and of those on both sides of
inner faces that they are valid; of damaged meshes that they are not, and why. usage: layercheck_test.py PROGRAM LAYERCHECK SHAPES"""
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy
import vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from program import NO_PICTURES, Run  # noqa: E402

BOX = """
geometry: {file: FOLDER/box.brep}
farfield: {shape: box, extent: 3}
sizing: {minimum: 0.1, maximum: 3, surface_maximum: 0.2, growth: 1.8, proximity: 0}
""" + NO_PICTURES
LAYERS = "layers: {first: 2e-3, growth: 1.5}\n"
ROD = """
geometry: {file: FOLDER/rod.brep, domain: fluid}
patches: {outer: {type: farfield}, ymin: {type: symmetry}}
sizing: {target_tetrahedra: 6000}
layers: {first: 2e-3, count: 10}
""" + NO_PICTURES
INNER = """
geometry: {file: FOLDER/FILE.brep, domain: fluid}
sizing: {target_tetrahedra: 6000}
layers: {first: 2e-3, count: 6, patches: {PATCH: {side: both}}}
""" + NO_PICTURES
CURVED_END = ("--sphere", "outer", "0", "0", "0", "2")
PLANE_END = ("--plane", "ymin", "0", "0", "0", "0", "1", "0")


class Tools:
    """The programs, and a folder for their files."""

    def __init__(self, program, arbiter, shapes, folder):
        self.program, self.arbiter, self.folder = program, arbiter, pathlib.Path(folder)
        subprocess.run([shapes, folder], check=True)

    def mesh(self, name, case, overrides=()):
        place = self.folder / name
        place.mkdir()
        run = Run(self.program, case.replace("FOLDER", str(self.folder)), 1, overrides, folder=place)
        assert run.code == 0, run.text
        return run.output

    def judge(self, mesh, *options):
        done = subprocess.run([self.arbiter, mesh, *options], capture_output=True, text=True, timeout=100)
        assert done.returncode in (0, 1), done
        assert done.stdout.rstrip().endswith("VALID yes" if done.returncode == 0 else "VALID NO"), done.stdout
        return done.returncode == 0, done.stdout

    def accept(self, mesh, *options, **least):
        """Expects a valid mesh, and numbers of what is named in the text."""
        valid, text = self.judge(mesh, *options)
        assert valid, text
        for what, number in least.items():
            found = re.search(what.replace("_", " ") + r" (\d+)", text)
            assert found and int(found.group(1)) >= number, (what, text)
        print(mesh.relative_to(self.folder), re.search("tetrahedra .*", text).group(), "VALID yes")
        return text

    def refuse(self, reason, mesh, *options):
        """Expects an invalid mesh, and the reason among others."""
        valid, text = self.judge(mesh, *options)
        assert not valid and re.search(reason, text), (reason, text)
        print(mesh.relative_to(self.folder), "VALID NO:", re.search(".*" + reason, text).group())


def read(output):
    reader = vtk.vtkXMLPUnstructuredGridReader()
    reader.SetFileName(str(output / "mesh.pvtu"))
    reader.Update()
    return reader.GetOutput()


def write(grid, file):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    assert writer.Write() == 1
    return file


def nodes_of(grid, cell):
    ids = vtk.vtkIdList()
    grid.GetCellPoints(cell, ids)
    return [ids.GetId(k) for k in range(ids.GetNumberOfIds())]


def first_of(grid, kind, layer=None):
    layers = grid.GetCellData().GetArray("layer")
    return next(c for c in range(grid.GetNumberOfCells())
                if grid.GetCellType(c) == kind and (layer is None or layers.GetTuple1(c) == layer))


def without(grid, cell):
    """All cells but one, with their regions. vtkExtractCells of VTK 9.1 crashes here now and then."""
    kept, ids = vtk.vtkUnstructuredGrid(), vtk.vtkIdList()
    kept.SetPoints(grid.GetPoints())
    for c in range(grid.GetNumberOfCells()):
        if c != cell:
            grid.GetCellPoints(c, ids)
            kept.InsertNextCell(grid.GetCellType(c), ids)
    region = numpy_to_vtk(numpy.delete(vtk_to_numpy(grid.GetCellData().GetArray("region")), cell), deep=True)
    region.SetName("region")
    kept.GetCellData().AddArray(region)
    return kept


def surface_of(output):
    return ("--surface", output / "surface.pvtp")


def check_fans(tools):
    """Hexahedra over the edges of a box; the surface off the walls is that of a run without layers."""
    bare = tools.mesh("bare", BOX)
    box = tools.mesh("box", BOX + LAYERS)
    text = tools.accept(box / "mesh.pvtu", *surface_of(box), "--walls", bare / "surface.pvtp", hexahedra=1000, pyramids=100)
    assert "area under prisms 4;" in text, text
    half = tools.mesh("half", BOX.replace("extent: 3", "extent: 3, symmetry: y") + LAYERS)
    tools.accept(half / "mesh.pvtu", *surface_of(half), hexahedra=500, quadrilaterals=100)
    fin = tools.mesh("fin", BOX.replace("box", "fin", 1).replace("extent: 3", "extent: 3, symmetry: y") + LAYERS)
    tools.accept(fin / "mesh.pvtu", *surface_of(fin), hexahedra=500, quadrilaterals=100)
    return box


def check_curved_end(tools):
    """A rod that meets a sphere and a plane of symmetry: the nodes on these lie on them, but the quadrilaterals bend."""
    rod = tools.mesh("rod", ROD)
    mesh = rod / "mesh.pvtu"
    text = tools.accept(mesh, *surface_of(rod), *CURVED_END, *PLANE_END, "--cylinder", "body", "0", "0", "1", "0", "0", "2", "0.4",
                        quadrilaterals=500)
    assert re.search("on CAD surfaces: quadrilaterals [1-9]", text), text
    tools.refuse("not planar [1-9]", mesh, *surface_of(rod))
    tools.refuse("polygons off them [1-9]", mesh, *surface_of(rod), *CURVED_END[:-1], "2.00000002")
    tools.refuse("surfaces of no polygon 1", mesh, *surface_of(rod), *CURVED_END, "--plane", "nowhere", *PLANE_END[2:])


def check_inner_faces(tools):
    """Layers on both sides of a plate and of the face between two boxes."""
    plate = tools.mesh("plate", INNER.replace("FILE", "plate").replace("PATCH", "baffle"))
    tools.accept(plate / "mesh.pvtu", *surface_of(plate), "--inner", plate / "interfaces.pvtp", hexahedra=100, inner_polygons=10)
    boxes = tools.mesh("boxes", INNER.replace("FILE", "boxes").replace("PATCH", "interface_0_1"))
    inner = ("--regions", "2", "--inner", boxes / "interfaces.pvtp")
    text = tools.accept(boxes / "mesh.pvtu", *surface_of(boxes), *inner, inner_polygons=10)
    assert "area under prisms 20;" in text, text
    tools.refuse("not inner [1-9]", boxes / "mesh.pvtu", *surface_of(boxes))
    tools.refuse("no inner polygons", boxes / "mesh.pvtu", *surface_of(boxes), "--inner", boxes / "nothing.pvtp")
    # One of the cells at the face is gone.
    grid, layers = read(boxes), read(boxes).GetCellData().GetArray("layer")
    beside = next(c for c in range(grid.GetNumberOfCells()) if layers.GetTuple1(c) == 1 and
                  sum(grid.GetPoint(node)[0] == 3 for node in nodes_of(grid, c)) == 3)
    hole = write(without(grid, beside), tools.folder / "beside.vtu")
    tools.refuse("on either side 1 ", hole, *surface_of(boxes), *inner)


def check_damage(tools, box):
    """Each kind of damage alone."""
    grid = read(box)
    nodes = nodes_of(grid, first_of(grid, vtk.VTK_WEDGE, 3))
    low, high = grid.GetPoint(nodes[0]), grid.GetPoint(nodes[3])
    grid.GetPoints().SetPoint(nodes[3], [2 * a - b for a, b in zip(low, high)])
    tools.refuse("inverted cells [1-9]", write(grid, tools.folder / "moved.vtu"), *surface_of(box))

    grid = read(box)
    cell = first_of(grid, vtk.VTK_HEXAHEDRON)
    at = int(grid.GetCells().GetOffsetsArray().GetTuple1(cell))
    vtk_to_numpy(grid.GetCells().GetConnectivityArray())[at:at + 8] = nodes_of(grid, cell)[4:] + nodes_of(grid, cell)[:4]
    mirrored = write(grid, tools.folder / "mirrored.vtu")
    tools.refuse("inverted cells 1 ", mirrored, *surface_of(box))
    tools.refuse("seen from one side twice 6", mirrored, *surface_of(box))

    grid = read(box)
    for kind in (vtk.VTK_TETRA, vtk.VTK_HEXAHEDRON):
        hole = write(without(grid, first_of(grid, kind)), tools.folder / f"without_{kind}.vtu")
        tools.refuse("DIFFER from the boundary", hole, *surface_of(box))


def main():
    with tempfile.TemporaryDirectory(prefix="aeroloom_test_") as folder:
        tools = Tools(*sys.argv[1:4], folder)
        box = check_fans(tools)
        check_curved_end(tools)
        check_inner_faces(tools)
        check_damage(tools, box)


if __name__ == "__main__":
    main()
