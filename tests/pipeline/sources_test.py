#!/usr/bin/env python3
"""Sizes that a case asks for are those of the mesh: on patches within a fifth, in regions within what the lattice of an octree can
follow, whose edges are 0.71 to 1.41 of a size. The mesh does not depend on the number of ranks.
usage: sources_test.py PROGRAM"""
import pathlib
import sys

import numpy
from program import COARSE_TRANSPORT, Run


REGIONS = {
    "wake": ("{shape: box, low: [38, -2, -2], high: [46, 2, 2], size: 0.8}",
             lambda x, y, z: (abs(x - 42) < 3.5) & (abs(y) < 1.5) & (abs(z) < 1.5), 0.8),
    "ball": ("{shape: sphere, center: [10, 0, 14], radius: 3, size: 0.7}",
             lambda x, y, z: (x - 10) ** 2 + y ** 2 + (z - 14) ** 2 < 6.25, 0.7),
    "jet": ("{shape: cylinder, from: [20, 12, -8], to: [30, 12, -8], radius: 1.6, size: 0.6}",
            lambda x, y, z: (abs(x - 25) < 4.5) & ((y - 12) ** 2 + (z + 8) ** 2 < 1.4), 0.6),
    "plume": ("{shape: cone, from: [20, -12, -8], to: [30, -12, -8], radius: 1.2, end_radius: 2.4, size: 0.7}",
              lambda x, y, z: (abs(x - 25) < 4.5) & ((y + 12) ** 2 + (z + 8) ** 2 < 0.9), 0.7),
}
PATCH, PATCH_SIZE = "wing_left_upper", 0.35
CASE = COARSE_TRANSPORT.replace("sizing: {", "sizing: {sources: {" + ", ".join(
    f"{name}: {text}" for name, (text, _, _) in REGIONS.items()) +
    ", spot: {shape: point, center: [0, 20, 0], size: 0.5}, edge: {shape: line, from: [5, 0, -12], to: [15, 0, -12], size: 0.4}}, ") + \
    f"patches: {{{PATCH}: {{size: {PATCH_SIZE}}}}}\noutput: {{pictures: false}}\n"


def read(path):
    from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLPPolyDataReader
    reader = vtkXMLPUnstructuredGridReader() if path.suffix == ".pvtu" else vtkXMLPPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def unique_pairs(cells, points):
    """Both nodes of each edge of cells, once. As numbers they sort much faster than as rows."""
    corners = cells.shape[1]
    pairs = numpy.sort(numpy.concatenate([cells[:, [a, b]] for a in range(corners) for b in range(a)]), axis=1).astype(numpy.int64)
    numbers = numpy.unique(pairs[:, 0] * points + pairs[:, 1])
    return numpy.stack([numbers // points, numbers % points], axis=1)


def edges_of(grid, corners, keeps=None):
    """Lengths and middles of edges of cells with so many corners; `keeps`: of these cells alone."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    cells = grid.GetCells() if corners == 4 else grid.GetPolys()
    nodes = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, corners)
    if keeps is not None:
        nodes = nodes[keeps]
    pairs = unique_pairs(nodes, len(points))
    ends = points[pairs[:, 0]], points[pairs[:, 1]]
    return numpy.linalg.norm(ends[0] - ends[1], axis=1), 0.5 * (ends[0] + ends[1])


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    runs = [Run(program, CASE, ranks) for ranks in (1, 3)]
    for run in runs:
        assert run.code == 0, run.text
    assert runs[0].report["mesh"]["hash"] == runs[1].report["mesh"]["hash"]
    lengths, middles = edges_of(read(runs[0].output / "mesh.pvtu"), 4)
    for name, (_, is_inside, size) in REGIONS.items():
        inside = lengths[is_inside(*middles.T)]
        assert len(inside) > 50, name
        median = numpy.median(inside)
        print(f"{name}: {len(inside)} edges, median {median:.3f} where {size} is asked for")
        assert 0.71 * size < median < 1.41 * size, name
    # Around a point and a line far from the body, where edges would be several metres long.
    near = lambda place: lengths[((middles - place) ** 2).sum(axis=1) < 1].min()
    assert near((0, 20, 0)) < 0.6 and near((10, 0, -12)) < 0.5
    surface = read(runs[0].output / "surface.pvtp")
    patch = [each["name"] for each in runs[0].report["patches"]].index(PATCH)
    from vtkmodules.util.numpy_support import vtk_to_numpy
    patches = vtk_to_numpy(surface.GetCellData().GetArray("patch"))
    lengths, _ = edges_of(surface, 3, patches == patch)
    median = numpy.median(lengths)
    print(f"{PATCH}: {len(lengths)} edges, median {median:.3f} where {PATCH_SIZE} is asked for")
    assert 0.8 * PATCH_SIZE < median < 1.2 * PATCH_SIZE

if __name__ == "__main__":
    main()
