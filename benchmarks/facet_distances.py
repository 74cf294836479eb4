#!/usr/bin/env python3
"""Measures how far meshes on faceted models are from the triangles of their files, both ways, and prints a table in Markdown.

Reads the outputs that `real_cad.py FOLDER --keep OUTPUTS` leaves. Both surfaces are sampled densely: corners, and points on
triangles no further apart than a fraction of the diagonal of the body. The nearest point of the other surface is found by a search of
its own, not the program's. Edges of the file are sides at which it turns by more than --angle; they are compared with edges of the
mesh between its faces. Lengths are over the diagonal, but for `over element`: over the longest side of the element there. Runs
on Python with VTK (python3-vtk9).
"""

import argparse
import collections
import pathlib

import numpy
import vtk
from printed_table import PrintedTable, add_page_option
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

Distances = collections.namedtuple("Distances", "away cell")  # per sample
THIN = 1e-3  # triangles lower than this fraction of their longest side have no normal to rely on


def numbers_of(line):
    return line.split("#")[0].split()


def read_off(file):
    words = [word for line in file.read_text().splitlines() for word in numbers_of(line)]
    head = words[0]
    points, faces = int(words[1]), int(words[2])
    width = 6 if "N" in head else 3
    values = numpy.array(words[4:4 + width * points], float).reshape(-1, width)[:, :3]
    polygons, at = [], 4 + width * points
    for _ in range(faces):
        count = int(words[at])
        polygons.append([int(word) for word in words[at + 1:at + 1 + count]])
        at += 1 + count
    return values, polygons


def read_smesh(file):
    lines = [words for words in map(numbers_of, file.read_text().splitlines()) if words]
    count, first = int(lines[0][0]), int(lines[1][0])
    points = numpy.array([line[1:4] for line in lines[1:1 + count]], float)
    facets = int(lines[1 + count][0])
    words = [word for line in lines[2 + count:] for word in line]
    has_marker, polygons, at = int(lines[1 + count][1]), [], 0
    for _ in range(facets):
        corners = int(words[at])
        polygons.append([int(word) - first for word in words[at + 1:at + 1 + corners]])
        at += 1 + corners + has_marker
    return points, polygons


def polygon_data(points, polygons):
    data, cells, places = vtk.vtkPolyData(), vtk.vtkCellArray(), vtk.vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype=float), deep=True))
    for polygon in polygons:
        cells.InsertNextCell(len(polygon), polygon)
    data.SetPoints(places)
    data.SetPolys(cells)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(data)
    triangles.Update()
    return triangles.GetOutput()


def read_file(file):
    if file.suffix == ".stl":
        reader = vtk.vtkSTLReader()
        reader.SetFileName(str(file))
        reader.Update()
        data = reader.GetOutput()
        return arrays_of(data)
    points, polygons = read_off(file) if file.suffix == ".off" else read_smesh(file)
    return arrays_of(polygon_data(points, polygons))


def arrays_of(data):
    """Points and triangles, equal points once."""
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    places, number = numpy.unique(points, axis=0, return_inverse=True)
    triangles = number.reshape(-1)[corners]
    proper = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (triangles[:, 2] != triangles[:, 0])
    return places, triangles[proper], proper


def read_mesh(file):
    """Points, triangles and their faces, without the far field."""
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    data = reader.GetOutput()
    points, triangles, proper = arrays_of(data)
    faces = vtk_to_numpy(data.GetCellData().GetArray("face"))[proper]
    return points, triangles, faces


def within(points, triangles, low, high):
    inside = ((points >= low) & (points <= high)).all(axis=1)
    return inside[triangles].all(axis=1)


def sample_triangles(points, triangles, apart, least):
    """Points on triangles, corners among them, no further apart than that, about, and their triangles. Triangles that are
    lower than that are sampled on their sides alone, and every side is cut into `least` parts or more."""
    corners = points[triangles]
    longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
    area = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    steps = numpy.where(area > apart * longest, numpy.ceil(longest / apart), 1).clip(least).astype(int)
    samples, owners = [], []
    for step in numpy.unique(steps):
        chosen = numpy.flatnonzero(steps == step)
        for i in range(step + 1):
            for j in range(step + 1 - i):
                weights = numpy.array([i, j, step - i - j]) / step
                samples.append(numpy.einsum("k,tkx->tx", weights, corners[chosen]))
                owners.append(chosen)
    for a in range(3):
        low = numpy.flatnonzero((steps == least) & (longest > least * apart))
        ends = triangles[low][:, [a, (a + 1) % 3]]
        along, which = sample_edges(points, ends, apart)
        samples.append(along)
        owners.append(low[which])
    samples, first = numpy.unique(numpy.concatenate(samples), axis=0, return_index=True)
    return samples, numpy.concatenate(owners)[first]


def sample_edges(points, edges, apart):
    ends = points[edges]
    steps = numpy.maximum(1, numpy.ceil(numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / apart)).astype(int)
    samples, owners = [numpy.empty((0, 3))], [numpy.empty(0, int)]
    for step in numpy.unique(steps):
        chosen = numpy.flatnonzero(steps == step)
        for i in range(step + 1):
            samples.append(ends[chosen, 0] + (i / step) * (ends[chosen, 1] - ends[chosen, 0]))
            owners.append(chosen)
    return numpy.concatenate(samples), numpy.concatenate(owners)


def locator_of(points, cells, count):
    data, array, places = vtk.vtkPolyData(), vtk.vtkCellArray(), vtk.vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    flat = numpy.concatenate([numpy.full((len(cells), 1), count), cells], axis=1).astype(numpy.int64).ravel()
    array.SetCells(len(cells), numpy_to_vtkIdTypeArray(flat, deep=True))
    data.SetPoints(places)
    (data.SetPolys if count == 3 else data.SetLines)(array)
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(data)
    locator.BuildLocator()
    return data, locator


def distances(samples, points, cells):
    """Of samples from triangles or segments."""
    data, locator = locator_of(points, cells, cells.shape[1])
    cell, nearest = vtk.vtkGenericCell(), [0.0, 0.0, 0.0]
    number, part, square = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    found, cells_at = numpy.empty(len(samples)), numpy.empty(len(samples), int)
    for i, sample in enumerate(samples.tolist()):
        locator.FindClosestPoint(sample, nearest, cell, number, part, square)
        found[i], cells_at[i] = square.get(), number.get()
    return Distances(numpy.sqrt(found), cells_at)


def sides_of(triangles):
    """Sides of two triangles, and those."""
    sides = numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    owner = numpy.tile(numpy.arange(len(triangles)), 3)
    order = numpy.lexsort((sides[:, 1], sides[:, 0]))
    sides, owner = sides[order], owner[order]
    _, first, count = numpy.unique(sides, axis=0, return_index=True, return_counts=True)
    first = first[count == 2]
    return sides[first], numpy.stack([owner[first], owner[first + 1]], axis=1)


def sharp_sides(points, triangles, angle):
    sides, owners = sides_of(triangles)
    corners = points[triangles]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
    area = numpy.linalg.norm(normals, axis=1)
    thin = area < THIN * longest**2
    normals /= numpy.maximum(area, 1e-300)[:, None]
    cosine = numpy.einsum("ix,ix->i", normals[owners[:, 0]], normals[owners[:, 1]])
    # Triangles of a file need not be turned alike: the side is passed in one direction by both where they are not.
    passes = [(triangles[owners[:, k]] == sides[:, :1]).argmax(axis=1) for k in (0, 1)]
    along = [triangles[owners[:, k], (passes[k] + 1) % 3] == sides[:, 1] for k in (0, 1)]
    cosine = numpy.where(along[0] == along[1], -cosine, cosine)
    return sides[(cosine < numpy.cos(numpy.radians(angle))) & ~thin[owners].any(axis=1)]


def compare(file, output, options):
    """Cells of the table."""
    points, triangles, _ = read_file(file)
    low, high = points.min(axis=0), points.max(axis=0)
    diagonal = numpy.linalg.norm(high - low)
    mesh, cells, faces = read_mesh(output / "surface.pvtp")
    body = within(mesh, cells, low - 1e-3 * diagonal, high + 1e-3 * diagonal)
    cells, faces = cells[body], faces[body]
    used = numpy.unique(cells)
    mesh, cells = mesh[used], numpy.searchsorted(used, cells)
    apart = diagonal / options.samples
    corners = mesh[cells]
    longest = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
    there = distances(sample_triangles(points, triangles, apart, 1)[0], mesh, cells)
    samples, owners = sample_triangles(mesh, cells, apart, 2)
    back = distances(samples, points, triangles)
    ratio = max((there.away / longest[there.cell]).max(), (back.away / longest[owners]).max())
    rms = numpy.sqrt(numpy.mean(numpy.concatenate([there.away, back.away])**2))
    nodes = distances(mesh, points, triangles).away.max()
    edges, beside = sides_of(cells)
    edges = edges[faces[beside[:, 0]] != faces[beside[:, 1]]]
    on_sides, kept = "–", "–"
    if len(edges):
        sides = sides_of(triangles)[0]
        on_sides = f"{distances(mesh[numpy.unique(edges)], points, sides).away.max() / diagonal:.0e}"
        sharp = sharp_sides(points, triangles, options.angle)
        if len(sharp):
            away = distances(sample_edges(points, sharp, apart)[0], mesh, edges).away
            kept = f"{100 * (away < options.near * diagonal).mean():.1f}"
    return (file.name, f"{len(triangles):,}", f"{len(cells):,}", f"{there.away.max() / diagonal:.1e}", f"{back.away.max() / diagonal:.1e}",
            f"{rms / diagonal:.1e}", f"{ratio:.3f}", f"{nodes / diagonal:.0e}", on_sides, kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="of the files")
    parser.add_argument("outputs", type=pathlib.Path, help="what real_cad.py kept")
    parser.add_argument("--angle", type=float, default=40, help="degrees at which a side is an edge")
    parser.add_argument("--near", type=float, default=1e-3, help="over the diagonal: how far from the mesh's edges an edge is kept")
    parser.add_argument("--samples", type=float, default=150, help="along the diagonal")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Files", ("file", "triangles", "of the mesh", "file to mesh", "mesh to file", "rms", "over element", "nodes",
                                   "nodes on edges", "edges kept, %"))
    for output in sorted(path for path in options.outputs.iterdir() if (path / "surface.pvtp").exists()):
        file = options.folder / output.name
        if file.suffix in (".stl", ".off", ".smesh"):
            table.add(*compare(file, output, options))
    table.save(options.page)


if __name__ == "__main__":
    main()
