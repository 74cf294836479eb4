#!/usr/bin/env python3
"""Boundary layers of Aeroloom, of Gmsh by extrusion and of OpenFOAM's snappyHexMesh on one wall, as a Markdown table.

usage: layer_peers.py PROGRAM CASE FOLDER [--limit SECONDS] [--gmsh-layers-only] [--page FILE]

CASE has a body in a far field, and `layers` with first, growth and count. Gmsh extrudes the triangles of our wall along its normals,
with the same heights, and fills what is left up to our far field; with a plane of symmetry it makes the layers alone. snappyHexMesh gets
our wall as STL, cells as wide as the median edge of our wall, and the same heights. All is measured in the meshes in one way: the share
of the wall whose cells of layers are all there with positive corners; of prisms and hexahedra the scaled Jacobian (least over the
corners, 1 for a right prism on an equilateral triangle or for a cube); negative ones are inverted cells. Seconds are of CPU; of ours
those of the stages layers to improve alone stand beside, which is what Gmsh does. Needs vtk and numpy for Python, gmsh, openfoam.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys

import numpy
import vtk
from layer_coverage import read
from printed_table import PrintedTable, add_page_option
from vtkmodules.util.numpy_support import vtk_to_numpy

import layer_peers_cases as cases

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Corners of a cell with their neighbours, right-handed; VTK's numbering of wedges has its first triangle seen from inside anticlockwise.
HEXAHEDRON = [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3)]
PRISM = [(0, 1, 2, 3), (1, 2, 0, 4), (2, 0, 1, 5), (3, 5, 4, 0), (4, 3, 5, 1), (5, 4, 3, 2)]


def scaled_jacobians(points, cells, corners, full):
    """Least over the corners, of each cell; `full` is the determinant of unit edges in the ideal cell."""
    least = numpy.full(len(cells), numpy.inf)
    for at, *ends in corners:
        edges = [points[cells[:, end]] - points[cells[:, at]] for end in ends]
        lengths = numpy.prod([numpy.linalg.norm(edge, axis=1) for edge in edges], axis=0)
        volume = numpy.einsum("ij,ij->i", numpy.cross(edges[0], edges[1]), edges[2])
        least = numpy.minimum(least, volume / numpy.where(lengths > 0, lengths, 1) / full)
    return least


def jacobians_of(points, cells):
    """Of prisms or hexahedra, whichever way all of them are numbered."""
    corners, full = (PRISM, numpy.sqrt(0.75)) if cells.shape[1] == 6 else (HEXAHEDRON, 1.0)
    found = scaled_jacobians(points, cells, corners, full)
    if len(found) and numpy.median(found) < 0:
        found = scaled_jacobians(points, cells[:, MIRRORED[len(corners)]], corners, full)
    return found


MIRRORED = {6: [0, 2, 1, 3, 5, 4], 8: [0, 3, 2, 1, 4, 7, 6, 5]}


def areas_of(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1)


def row_of(jacobians, covered, seconds, cells):
    """Cells of the table; `covered` are the shares of the wall with all layers and with any."""
    worst = ("–", "–", "–")
    if len(jacobians):
        worst = (f"{jacobians.min():.3f}", f"{numpy.percentile(jacobians, 1):.3f}", f"{(jacobians <= 0).sum():,}")
    return f"{len(jacobians):,}", *(f"{100 * share:.2f}" for share in covered), *worst, f"{cells:,}", seconds


def timed(command, folder, log, limit, where=None):
    """CPU seconds of a command, run in the folder or elsewhere; what it says is in the log."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = os.environ | {"WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"), "PWD": str(where or folder)}
    with open(folder / log, "w", encoding="utf-8") as out:
        try:
            code = subprocess.run([str(word) for word in command], cwd=where or folder, stdout=out, stderr=subprocess.STDOUT, timeout=limit,
                                  env=environment, check=False).returncode
        except subprocess.TimeoutExpired:
            sys.exit(f"{command[0]}: not within {limit} s. Remedy: a larger --limit or a coarser case")
    if code != 0:
        sys.exit(f"{command[0]} ended with {code}; see {folder / log}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def grid_arrays(grid, shape, corners):
    """Points and the cells of one shape."""
    types = vtk_to_numpy(grid.GetCellTypesArray())
    starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1][types == shape]
    return vtk_to_numpy(grid.GetCells().GetConnectivityArray())[starts[:, None] + numpy.arange(corners)], types == shape


class Wall:
    """The boundary of our mesh: points that are one where they coincide, triangles away from the fluid's inside, which are walls."""

    def __init__(self, folder):
        surface = read(vtk.vtkXMLPPolyDataReader(), folder / "surface.pvtp")
        report = json.loads((folder / "report.json").read_text())
        layered = [patch["name"] for patch in report["layers"]["patches"] if patch["count"] > 0]
        rows = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
        self.points, numbers = numpy.unique(rows, axis=0, return_inverse=True)
        polygons = surface.GetPolys()
        starts, sizes = vtk_to_numpy(polygons.GetOffsetsArray())[:-1], numpy.diff(vtk_to_numpy(polygons.GetOffsetsArray()))
        chosen = sizes == 3
        corners = vtk_to_numpy(polygons.GetConnectivityArray())[starts[chosen, None] + numpy.arange(3)]
        self.triangles = numbers.ravel()[corners]
        names = surface.GetFieldData().GetAbstractArray("patch_names")
        wanted = [i for i in range(names.GetNumberOfValues()) if names.GetValue(i) in layered]
        self.is_wall = numpy.isin(vtk_to_numpy(surface.GetCellData().GetArray("patch"))[chosen], wanted)
        self.walls = self.triangles[self.is_wall]
        ends = numpy.concatenate([self.walls[:, [0, 1]], self.walls[:, [1, 2]], self.walls[:, [2, 0]]])
        self.edge = numpy.median(numpy.linalg.norm(self.points[ends[:, 0]] - self.points[ends[:, 1]], axis=1))
        # Open where the wall ends on a plane of symmetry.
        self.closed = (numpy.unique(numpy.sort(ends, axis=1), axis=0, return_counts=True)[1] == 2).all()
        asked = report["layers"]["patches"][0]
        self.heights = cases.heights(asked["first"], asked["growth"], asked["constant"], asked["count"])
        self.stages = {stage["name"]: stage["cpu_seconds_mean"] for stage in report["stages"]}


def ours(folder):
    """The prisms' Jacobians, the shares of the wall by the report (layer_coverage.py finds the same in files), all cells."""
    report = json.loads((folder / "report.json").read_text())
    grid = read(vtk.vtkXMLPUnstructuredGridReader(), folder / "mesh.pvtu")
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    prisms, _ = grid_arrays(grid, vtk.VTK_WEDGE, 6)
    patches = report["layers"]["patches"]
    area = sum(p["area"] for p in patches)
    covered = [sum(share * p["area"] for share, p in zip(shares, patches)) / area for shares in (
        [p["full"] for p in patches], [1 - p["empty"] for p in patches])]
    return jacobians_of(points, prisms), covered, grid.GetNumberOfCells()


def gmsh(folder, wall, options):
    """Prisms by triangle of the wall, which Gmsh extrudes in their order."""
    whole = wall.closed and not options.gmsh_layers_only
    cases.write_gmsh(folder, wall, whole)
    seconds = timed(["gmsh", "layers.geo", "-3", "-algo", "hxt", "-nt", "1", "-format", "vtk", "-bin", "-o", "mesh.vtk"], folder,
                    "log.gmsh", options.limit)
    grid = read(vtk.vtkUnstructuredGridReader(), folder / "mesh.vtk")
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    prisms, _ = grid_arrays(grid, vtk.VTK_WEDGE, 6)
    tetrahedra, _ = grid_arrays(grid, vtk.VTK_TETRA, 4)
    jacobians = jacobians_of(points, prisms)
    count = len(wall.heights)
    bases = prisms.reshape(-1, count, 6)[:, 0]
    areas = numpy.minimum(areas_of(points, bases[:, :3]), areas_of(points, bases[:, 3:]))
    good = jacobians.reshape(-1, count) > 0
    covered = [areas[good.all(axis=1)].sum() / areas.sum(), areas[good[:, 0]].sum() / areas.sum()]
    return jacobians, covered, seconds, len(prisms) + len(tetrahedra)


def snappy(folder, wall, options):
    """The share by area of faces with all layers, from the field that it writes; Jacobians of hexahedra and prisms in layers."""
    cases.write_snappy(folder, wall)
    seconds = sum(timed([command], folder, f"log.{command}", options.limit) for command in ("blockMesh", "surfaceFeatureExtract"))
    seconds += timed(["snappyHexMesh", "-overwrite"], folder, "log.snappyHexMesh", options.limit)
    reader = vtk.vtkOpenFOAMReader()
    (folder / "mesh.foam").touch()
    reader.SetFileName(str(folder / "mesh.foam"))
    reader.SkipZeroTimeOff()
    reader.DecomposePolyhedraOff()
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.EnableAllCellArrays()
    reader.Update()
    blocks, grid, patch = reader.GetOutput().NewIterator(), None, None
    while not blocks.IsDoneWithTraversal():
        name = blocks.GetCurrentMetaData().Get(vtk.vtkCompositeDataSet.NAME())
        if name == "internalMesh":
            grid = blocks.GetCurrentDataObject()
        elif name == "wall":
            patch = blocks.GetCurrentDataObject()
        blocks.GoToNextItem()
    number = vtk_to_numpy(patch.GetCellData().GetArray("nSurfaceLayers"))
    measure = vtk.vtkCellSizeFilter()
    measure.SetInputData(patch)
    measure.Update()
    areas = vtk_to_numpy(measure.GetOutput().GetCellData().GetArray("Area"))
    covered = [areas[number >= least].sum() / areas.sum() for least in (len(wall.heights) - 0.5, 0.5)]
    return *snappy_jacobians(folder, grid), covered, seconds, grid.GetNumberOfCells()


def snappy_jacobians(folder, grid):
    """Of the cells in the set that snappyHexMesh writes of its layers; polyhedra have no Jacobian and are counted."""
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    inside = numpy.zeros(grid.GetNumberOfCells(), bool)
    inside[cases.cells_in_set(folder)] = True
    found = []
    for shape, corners in ((vtk.VTK_HEXAHEDRON, 8), (vtk.VTK_WEDGE, 6)):
        cells, chosen = grid_arrays(grid, shape, corners)
        found.append(jacobians_of(points, cells[inside[chosen]]))
    found = numpy.concatenate(found)
    return found, inside.sum() - len(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("case", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=900.0)
    parser.add_argument("--gmsh-layers-only", action="store_true", help="let Gmsh leave the rest empty")
    add_page_option(parser)
    options = parser.parse_args()
    root = options.folder.resolve()
    folders = {name: root / name for name in ("ours", "gmsh", "snappy")}
    for folder in folders.values():
        folder.mkdir(parents=True, exist_ok=True)
    whole = timed([options.program.resolve(), "run", options.case.resolve(), "--set", f"output.directory={folders['ours']}"], root,
                  "log.ours", options.limit, ROOT)
    wall = Wall(folders["ours"])
    part = sum(wall.stages[name] for name in ("layers", "decompose", "volume", "improve"))
    note = (f"{len(wall.walls):,} triangles of walls, median edge {wall.edge:.4g}, {len(wall.heights)} layers from {wall.heights[0]:.4g} "
            "on.")
    print(f"{note}\n")
    table = PrintedTable(options.case.stem, ("mesher", "prisms and hexahedra of layers", "all layers, % of the wall", "any",
                                             "least Jacobian", "1 %", "inverted", "all cells", "CPU s"))
    jacobians, covered, cells = ours(folders["ours"])
    table.add("Aeroloom", *row_of(jacobians, covered, f"{whole:.1f} ({part:.1f})", cells))
    jacobians, covered, seconds, cells = gmsh(folders["gmsh"], wall, options)
    table.add("Gmsh", *row_of(jacobians, covered, f"{seconds:.1f}", cells))
    jacobians, others, covered, seconds, cells = snappy(folders["snappy"], wall, options)
    table.add("snappyHexMesh", *row_of(jacobians, covered, f"{seconds:.1f}", cells))
    left = f"snappyHexMesh: {others:,} more cells of layers are neither prisms nor hexahedra"
    print(f"\n{left}")
    table.save(options.page, f"{note} {left}.")


if __name__ == "__main__":
    main()
