#!/usr/bin/env python3
"""Boundary layers of a finished run, measured in its files and beside what its report says.

usage: layer_coverage.py OUTPUT [OUTPUT ...] [--tolerance T] [--page FILE]

Counts, heights and areas come from mesh.pvtu and surface.pvtp alone; report.json tells which layers were asked for, and is compared
with. A column is a chain of nodes over a vertex of a wall, each one layer above the one before. Each column counts for a third of the
triangles around its vertex. Per patch, of the file (of the report): percent of the area whose columns have all layers, fewer, none; the
mean number of layers. Of the file alone: percent of the area of triangles without any cell of a layer; the first height along the normals
of the triangles over the one asked for (5, 50, 95 % of the corners); the growth from layer to layer after the constant ones (5, 50, 95 %
of the columns, each by its mean). Ends with 1 where file and report differ by more than T (default 0.002, of the area, of the mean
number relatively). Needs Python's vtk and numpy (python3-vtk9).
"""
import argparse
import json
import pathlib
import sys

import numpy
import vtk
from printed_table import PrintedTable, add_page_option
from vtkmodules.util.numpy_support import vtk_to_numpy

MOST_LAYERS, ISOTROPIC = 1000, 0.7
SMOOTH = 0.5 * ISOTROPIC  # the least at which the step to tetrahedra is smooth
CORNERS = {vtk.VTK_TETRA: 4, vtk.VTK_PYRAMID: 5, vtk.VTK_WEDGE: 6}


def read(reader, path):
    if not path.exists():
        sys.exit(f"{path}: no such file. Remedy: name the output directory of a run with formats vtu")
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def cells_of(cells, corners, chosen):
    """Points of the chosen cells, each of so many corners."""
    starts = vtk_to_numpy(cells.GetOffsetsArray())[:-1][chosen]
    return vtk_to_numpy(cells.GetConnectivityArray())[starts[:, None] + numpy.arange(corners)]


class Mesh:
    """The layers' cells by shape and the walls' triangles, on points that are one where their coordinates agree."""

    def __init__(self, folder):
        grid = read(vtk.vtkXMLPUnstructuredGridReader(), folder / "mesh.pvtu")
        surface = read(vtk.vtkXMLPPolyDataReader(), folder / "surface.pvtp")
        of_grid, of_surface = (vtk_to_numpy(d.GetPoints().GetData()).astype(float) for d in (grid, surface))
        rows = numpy.ascontiguousarray(numpy.vstack([of_grid, of_surface]) + 0.0)  # -0 is 0
        self.points, numbers = numpy.unique(rows.view([("", float)] * 3).ravel(), return_inverse=True)
        self.points = self.points.view(float).reshape(-1, 3)
        in_grid, in_surface = numbers[:len(of_grid)], numbers[len(of_grid):]
        layer = vtk_to_numpy(grid.GetCellData().GetArray("layer")) if grid.GetCellData().HasArray("layer") else None
        if layer is None:
            sys.exit(f"{folder}/mesh.pvtu: there is no cell array 'layer', so the run had no boundary layers")
        types = vtk_to_numpy(grid.GetCellTypesArray())
        self.cells, self.layers = {}, {}
        for shape, corners in CORNERS.items():
            chosen = numpy.flatnonzero((types == shape) & (layer > 0))
            self.cells[shape], self.layers[shape] = in_grid[cells_of(grid.GetCells(), corners, chosen)], layer[chosen]
        polygons = surface.GetPolys()
        triangles = numpy.flatnonzero(numpy.diff(vtk_to_numpy(polygons.GetOffsetsArray())) == 3)
        self.triangles = in_surface[cells_of(polygons, 3, triangles)]
        self.patch = vtk_to_numpy(surface.GetCellData().GetArray("patch"))[triangles]
        names = surface.GetFieldData().GetAbstractArray("patch_names")
        self.patch_names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]

    def heights_of(self, a, b):
        return numpy.linalg.norm(self.points[b] - self.points[a], axis=1)


def levels_of(mesh, on_wall):
    """The layer that each node ends; 0 on walls, a large number off the layers."""
    level = numpy.full(len(mesh.points), MOST_LAYERS + 1)
    for shape, cells in mesh.cells.items():
        numpy.minimum.at(level, cells.ravel(), numpy.repeat(mesh.layers[shape], CORNERS[shape]))
    level[on_wall] = 0
    return level


def steps_of(mesh, level):
    """The node above each node, -1 none: what a prism has over it; elsewhere the nearest node of the next level in a cell."""
    lower, upper = [], []
    prisms = mesh.cells[vtk.VTK_WEDGE]
    for i in range(3):
        lower.append(prisms[:, i]), upper.append(prisms[:, i + 3])
    above = numpy.full(len(mesh.points), -1)
    for a, b in zip(lower, upper):
        rising = level[a] < level[b]
        above[a[rising]], above[b[~rising]] = b[rising], a[~rising]
    low, high = [], []
    for shape in (vtk.VTK_PYRAMID, vtk.VTK_TETRA):
        cells, layer = mesh.cells[shape], mesh.layers[shape]
        for i in range(CORNERS[shape]):
            for j in range(CORNERS[shape]):
                a, b = cells[:, i], cells[:, j]
                kept = (level[a] == layer - 1) & (level[b] == layer)
                low.append(a[kept]), high.append(b[kept])
    low, high = numpy.concatenate(low), numpy.concatenate(high)
    order = numpy.lexsort((mesh.heights_of(low, high), high))
    low, high = low[order], high[order]
    nearest = numpy.ones(len(high), bool)
    nearest[1:] = high[1:] != high[:-1]
    low, high = low[nearest], high[nearest]
    missing = above[low] < 0
    above[low[missing]] = high[missing]
    return above


class Columns:
    """Over all vertices of layered walls: counts, first nodes, mean growths after the constant layers."""

    def __init__(self, mesh, above, bases, constant):
        self.count, self.first_node = numpy.zeros(len(mesh.points), int), numpy.full(len(mesh.points), -1)
        self.growth, self.last_height = numpy.full((2, len(mesh.points)), numpy.nan)
        self.first_node[bases] = above[bases]
        constant_height, last_height = numpy.full((2, len(bases)), numpy.nan)
        live, here = numpy.arange(len(bases)), bases
        for k in range(1, MOST_LAYERS + 1):
            nexts = above[here]
            live, here, nexts = live[nexts >= 0], here[nexts >= 0], nexts[nexts >= 0]
            if len(live) == 0:
                break
            last_height[live] = mesh.heights_of(here, nexts)
            ends = live[constant[live] == k]
            constant_height[ends] = last_height[ends]
            self.count[bases[live]] += 1
            here = nexts
        steps = self.count[bases] - constant
        self.last_height[bases] = last_height
        grows = steps > 0
        self.growth[bases[grows]] = (last_height[grows] / constant_height[grows]) ** (1 / steps[grows])


def wanted_counts(asked, edge):
    """As many layers as it takes until the last is 0.7 of the edge, as the other keys allow."""
    count = numpy.full(len(edge), asked["count"] or MOST_LAYERS, float)
    if asked["growth"] > 1:
        steps = numpy.log(ISOTROPIC * edge / asked["first"]) / numpy.log(asked["growth"])
        count = numpy.minimum(count, numpy.where(steps < 0, 1, asked["constant"] + numpy.round(steps)))
    if asked["total"]:
        heights = asked["first"] * asked["growth"] ** numpy.maximum(0, numpy.arange(MOST_LAYERS) - asked["constant"] + 1)
        count = numpy.minimum(count, numpy.searchsorted(numpy.cumsum(heights), asked["total"] * (1 + 1e-12)))
    return numpy.maximum(count, 1)


def mean_edges(mesh, triangles):
    total, number = numpy.zeros(len(mesh.points)), numpy.zeros(len(mesh.points))
    for i in range(3):
        a, b = triangles[:, i], triangles[:, (i + 1) % 3]
        length = mesh.heights_of(a, b)
        for end in (a, b):
            numpy.add.at(total, end, length), numpy.add.at(number, end, 1)
    return total / numpy.maximum(number, 1)


def measure(folder):
    """Rows of patches: name, what the files have, what the report says."""
    mesh, report = Mesh(folder), json.loads((folder / "report.json").read_text())
    asked = {row["name"]: row for row in report["layers"]["patches"]}
    names = numpy.array(mesh.patch_names)[mesh.patch]
    layered = mesh.triangles[numpy.isin(names, list(asked))]
    wall_patch = names[numpy.isin(names, list(asked))]
    edge = mean_edges(mesh, layered)
    bases = numpy.unique(layered)
    wanted, constant = numpy.full(len(mesh.points), numpy.inf), numpy.full(len(mesh.points), MOST_LAYERS)
    for name, row in asked.items():
        of_patch = numpy.unique(layered[wall_patch == name])
        wanted[of_patch] = numpy.minimum(wanted[of_patch], wanted_counts(row, edge[of_patch]))
        constant[of_patch] = numpy.minimum(constant[of_patch], row["constant"])
    on_wall = numpy.zeros(len(mesh.points), bool)
    on_wall[bases] = True
    above = steps_of(mesh, levels_of(mesh, on_wall))
    columns = Columns(mesh, above, bases, constant[bases])
    corner = mesh.points[layered]
    normal = numpy.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = 0.5 * numpy.linalg.norm(normal, axis=1)
    normal /= 2 * area[:, None]
    rows = []
    for name, row in asked.items():
        mine = wall_patch == name
        if not mine.any():
            continue
        triangles, areas = layered[mine], area[mine]
        counts, whole = columns.count[triangles], areas.sum()
        part = lambda chosen: (areas[:, None] * chosen).sum() / 3 / whole
        some = counts > 0
        full = (counts >= wanted[triangles]) | some & (columns.last_height[triangles] >= SMOOTH * edge[triangles])
        rise = numpy.abs(((mesh.points[columns.first_node[triangles]] - mesh.points[triangles]) * normal[mine][:, None, :]).sum(axis=2))
        growth = columns.growth[numpy.unique(triangles)]
        growth = growth[numpy.isfinite(growth)]
        rows.append((name, {"full": part(full), "partial": part(some & ~full), "empty": part(~some), "layers_mean": part(counts),
                            "bare": areas[counts.max(axis=1) == 0].sum() / whole,
                            "first": numpy.percentile(rise[some], (5, 50, 95)) / row["first"] if some.any() else [numpy.nan] * 3,
                            "growth": numpy.percentile(growth, (5, 50, 95)) if len(growth) else [numpy.nan] * 3}, row))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", nargs="+", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=0.002)
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Patches", ("patch", "all, %", "fewer, %", "none, %", "mean number", "bare, %", "first height", "growth"))
    agree = True
    for folder in options.output:
        for name, found, said in measure(folder):
            shares = (f"{100 * found[key]:.2f} ({100 * said[key]:.2f})" for key in ("full", "partial", "empty"))
            first, growth = (" ".join(f"{value:.3f}" for value in found[key]) for key in ("first", "growth"))
            table.add(name, *shares, f"{found['layers_mean']:.2f} ({said['layers_mean']:.2f})", f"{100 * found['bare']:.2f}", first, growth)
            agree &= all(abs(found[key] - said[key]) <= options.tolerance for key in ("full", "partial", "empty"))
            agree &= abs(found["layers_mean"] - said["layers_mean"]) <= options.tolerance * max(1, said["layers_mean"])
    table.save(options.page)
    if not agree:
        sys.exit("the files and the report differ")


if __name__ == "__main__":
    main()
