#!/usr/bin/env python3
"""Sizes of surface meshes over those of another by distance from trailing edges, as a Markdown table.

usage: patch_sizes.py THICK/surface.pvtp THIN/surface.pvtp ... [--patches] [--page FILE]

All are meshes of one aircraft whose trailing edges differ: THICK's patches that end in `trailing_edge` say where these
are. The size of a triangle is the mean of its edges; compared are its averages by area over triangles of one patch, by
distance from the nearest trailing edge in parts of the farthest that the patch reaches. Bins of fewer than 20 triangles
in either mesh are left out. The table has medians over patches, and all bins of all patches from AWAY on together.

Needs vtk and numpy.
"""
import argparse
import pathlib

import numpy
import vtk
from printed_table import PrintedTable, add_page_option
from vtk.util.numpy_support import vtk_to_numpy

EDGES = [0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0]
AWAY = 0.3
LEAST_TRIANGLES = 20


def read(path):
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def patch_names(surface):
    names = surface.GetFieldData().GetAbstractArray("patch_names")
    return [names.GetValue(k) for k in range(names.GetNumberOfValues())]


class Triangles:
    """Centres, areas, sizes and patch names of a surface's triangles."""

    def __init__(self, surface):
        corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        points = vtk_to_numpy(surface.GetPoints().GetData())[corners]
        self.centre = points.mean(axis=1)
        self.area = 0.5 * numpy.linalg.norm(numpy.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1)
        self.size = numpy.linalg.norm(points - numpy.roll(points, 1, axis=1), axis=2).mean(axis=1)
        self.patch = numpy.array(patch_names(surface))[vtk_to_numpy(surface.GetCellData().GetArray("patch"))]

    def measure_from(self, locator):
        """Sets each triangle's distance from the locator's cells."""
        at, cell, sub, square = [0.0] * 3, vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
        generic = vtk.vtkGenericCell()
        self.distance = numpy.empty(len(self.centre))
        for k, centre in enumerate(self.centre):
            locator.FindClosestPoint(centre, at, generic, cell, sub, square)
            self.distance[k] = square.get() ** 0.5


def trailing_edges(surface):
    """A locator of the triangles of trailing edges."""
    names = patch_names(surface)
    patch = vtk_to_numpy(surface.GetCellData().GetArray("patch"))
    chosen = numpy.isin(patch, [k for k, name in enumerate(names) if name.endswith("trailing_edge")])
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)[chosen]
    cells = vtk.vtkCellArray()
    for triangle in corners:
        cells.InsertNextCell(3, [int(corner) for corner in triangle])
    strips = vtk.vtkPolyData()
    strips.SetPoints(surface.GetPoints())
    strips.SetPolys(cells)
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(strips)
    locator.BuildLocator()
    return locator, strips


def average(triangles, chosen):
    return (triangles.size[chosen] * triangles.area[chosen]).sum() / triangles.area[chosen].sum()


def compare(thick, thin):
    """Rows of patch, size, ratio of the whole patch, and ratios by bins."""
    for name in sorted(set(thick.patch) & set(thin.patch)):
        both = [t.patch == name for t in (thick, thin)]
        if name.endswith("trailing_edge") or min(b.sum() for b in both) < LEAST_TRIANGLES:
            continue
        reach = thick.distance[both[0]].max()
        bins = []
        for low, high in zip(EDGES, EDGES[1:]):
            inside = [b & (t.distance >= low * reach) & (t.distance < high * reach) for t, b in zip((thick, thin), both)]
            enough = min(i.sum() for i in inside) >= LEAST_TRIANGLES
            bins.append(average(thin, inside[1]) / average(thick, inside[0]) if enough else None)
        yield name, reach, average(thick, both[0]), average(thin, both[1]) / average(thick, both[0]), bins


def show(ratio):
    return "–" if ratio is None else f"{ratio:.2f}"


def print_patches(rows):
    print("| patch | reaches | size | ratio | " + " | ".join(f"to {high:g}" for high in EDGES[1:]) + " |\n" + "|---" * (3 + len(EDGES)) + "|")
    for name, reach, size, ratio, bins in rows:
        print(f"| {name} | {reach:.3g} | {size:.3g} | {ratio:.2f} | " + " | ".join(map(show, bins)) + " |")
    print()


def summary(label, rows):
    """The medians of each bin over patches, and all bins from AWAY on together."""
    columns = [[row[4][k] for row in rows if row[4][k] is not None] for k in range(len(EDGES) - 1)]
    away = [ratio for low, column in zip(EDGES, columns) if low >= AWAY for ratio in column]
    medians = [show(numpy.median(column)) if column else "–" for column in columns]
    return label, *medians, show(numpy.median(away)), f"{min(away):.2f} – {max(away):.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("thick")
    parser.add_argument("thin", nargs="+")
    parser.add_argument("--patches", action="store_true", help="a table of patches for each THIN first")
    add_page_option(parser)
    options = parser.parse_args()
    surface = read(options.thick)
    locator, strips = trailing_edges(surface)
    thick = Triangles(surface)
    thick.measure_from(locator)
    lines = []
    for path in options.thin:
        thin = Triangles(read(path))
        thin.measure_from(locator)
        rows = list(compare(thick, thin))
        if options.patches:
            print_patches(rows)
        lines.append(summary(pathlib.Path(path).parent.name, rows))
    table = PrintedTable("Sizes", ("mesh", *(f"to {high:g}" for high in EDGES[1:]), f"from {AWAY:g}: median", "least – largest"))
    for line in lines:
        table.add(*line)
    table.save(options.page)


if __name__ == "__main__":
    main()
