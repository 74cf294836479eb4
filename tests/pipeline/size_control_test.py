#!/usr/bin/env python3
"""Sizes that a case asks for by formulas and at walls, wakes and edges are those of the mesh: the median of edges over what is asked
for at their middles is within a fifth of one; where one size is asked for in all of a region, within what the lattice of an octree
can follow, whose edges are 0.71 to 1.41 of a size. The mesh does not depend on the number of ranks, nor on the length that a case
takes for 1. usage: size_control_test.py PROGRAM"""
import pathlib
import sys

import numpy

from program import COARSE_TRANSPORT, Run
from sources_test import read, unique_pairs

CENTER = numpy.array((20, 30, 25))
# Each far enough from the others; lengths in metres. With a reference length of 2 m all are half as long.
SIZING = """
  expression: "max({0[0.7]}, 0.25*sqrt((x - {0[20]})^2 + (y - {0[30]})^2 + (z - {0[25]})^2))"
  sources:
    line: {{shape: wake, from: [{0[10]}, {0[20]}, {0[-20]}], to: [{0[10]}, {0[28]}, {0[-20]}], direction: [1, 0, 0], length: {0[15]},
           size: {0[0.5]}, end_size: {0[1.5]}}}
    wing: {{shape: wake, behind: ['wing_left_*'], direction: [3, 0, 0], length: {0[15]}, size: {0[0.5]}, end_size: {0[1.5]}}}
  walls:
    tail: {{faces: ['vertical_tail_*'], size: {0[0.4]}, distance: {0[1.5]}}}
  edges:
    root: {{between: ['wing_right_upper', 'fuselage*'], size: {0[0.2]}}}
    corner: {{low: [{0[20]}, {0[16.9]}, {0[-5]}], high: [{0[30]}, {0[17.1]}, {0[5]}], size: {0[0.1]}}}
"""
SIZES = {"minimum": 0.5, "maximum": 20, "surface_maximum": 4}


class Lengths:
    """Text of lengths over the reference length."""

    def __init__(self, unit):
        self.unit = unit

    def __getitem__(self, length):
        return repr(float(length) / self.unit)


def case_of(unit):
    text = COARSE_TRANSPORT.split("sizing:")[0] + "sizing:\n  curvature_angle: 30\n  growth: 1.8\n  proximity: 0\n"
    text += "".join(f"  {name}: {length / unit!r}\n" for name, length in SIZES.items())
    if unit != 1:
        text += f"  reference_length: {unit}\n"
    return text + SIZING.format(Lengths(unit)) + "output: {pictures: false}\n"


def edges_of(file):
    """Ends of all edges of tetrahedra or triangles, by their points, and these."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    grid = read(file)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells, corners = (grid.GetCells(), 4) if file.suffix == ".pvtu" else (grid.GetPolys(), 3)
    nodes = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, corners)
    return unique_pairs(nodes, len(points)), points, nodes, grid


def check(what, lengths, wanted, low=0.8, high=1.2):
    ratio = numpy.median(lengths / wanted)
    print(f"{what}: {len(lengths)} edges, median {ratio:.3f} of what is asked for")
    assert len(lengths) >= 8 and low < ratio < high, what


def points_of(run):
    """Points of each patch of the surface."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    pairs, points, nodes, grid = edges_of(run.output / "surface.pvtp")
    patches = vtk_to_numpy(grid.GetCellData().GetArray("patch"))
    names = [each["name"] for each in run.report["patches"]]
    return pairs, points, {name: set(nodes[patches == p].ravel().tolist()) for p, name in enumerate(names)}


def check_mesh(run):
    pairs, points, _, _ = edges_of(run.output / "mesh.pvtu")
    middles = 0.5 * (points[pairs[:, 0]] + points[pairs[:, 1]])
    lengths = numpy.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    away = numpy.linalg.norm(middles - CENTER, axis=1)
    inside = (away > 4) & (away < 16)
    check("expression", lengths[inside], 0.25 * away[inside])

    on_surface, surface, patches = points_of(run)
    x, y, z = middles.T
    size = 0.5 + (x - 10) / 15
    inside = (abs(z + 20) < 0.3 * size) & (21 < y) & (y < 27) & (10.5 < x) & (x < 24)
    check("wake of a line", lengths[inside], size[inside])
    wing = surface[list(patches["wing_left_upper"])]
    wing = wing[abs(wing[:, 1] + 10) < 0.8]
    edge = wing[numpy.argmax(wing[:, 0])]
    size = 0.5 + (x - edge[0]) / 15
    inside = (abs(z - edge[2]) < 0.3 * size) & (abs(y - edge[1]) < 1) & (edge[0] + 1.5 < x) & (x < edge[0] + 13)
    check("wake of a wing", lengths[inside], size[inside])

    tail = surface[list(patches["vertical_tail_left"] | patches["vertical_tail_right"])]
    low, high = tail.min(axis=0), tail.max(axis=0)
    near = numpy.all((middles > low - 1.5) & (middles < high + 1.5), axis=1)
    apart = numpy.array([numpy.linalg.norm(tail - m, axis=1).min() for m in middles[near]])
    check("walls", lengths[near][(apart > 0.4) & (apart < 1.4)], 0.4, 0.71, 1.41)

    ends = surface[on_surface[:, 0]], surface[on_surface[:, 1]]
    along = numpy.linalg.norm(ends[0] - ends[1], axis=1)
    root = patches["wing_right_upper"] & set().union(*(p for name, p in patches.items() if name.startswith("fuselage")))
    on_root = numpy.array([a in root and b in root for a, b in on_surface.tolist()])
    check("edges between patches", along[on_root], 0.2)
    tip = [patches["wing_right_tip"] & patches[side] for side in ("wing_right_upper", "wing_right_lower")]
    on_tip = numpy.array([any(a in side and b in side for side in tip) for a, b in on_surface.tolist()])
    check("edges in a box", along[on_tip], 0.1)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    runs = [Run(program, case_of(unit), ranks) for unit, ranks in ((1, 1), (2, 3))]
    for run in runs:
        assert run.code == 0, run.text
        assert run.report["mesh"]["hash"] == runs[0].report["mesh"]["hash"]
    check_mesh(runs[0])

if __name__ == "__main__":
    main()
