#!/usr/bin/env python3
"""Meshes at levels of the prediction workshops against what their guidelines ask for, as Markdown tables.

usage: levels.py [--cut AXIS FROM TO]... OUTPUT [OUTPUT ...]

An OUTPUT is the output folder of a run with `sizing.level`, the flow along x, in the order of the levels. The surface is cut at 41
planes normal to AXIS (y or z) between FROM and TO. A closed section whose thickness is below 0.4 of its length along x is one of a
lifting body; the longest of a plane is the wing's, if AXIS is y. The spacing at an end of a section is the mean edge of the eight
nearest triangles that the plane cuts. It is asked for as the level's fraction of the section's chord; at a trailing edge whose
strip is too thin for that, as the strip's width over the level's number of cells. Medians of the ratios are printed, with counts
against the cube of the ratio of sizes from level to level, and against the forecast where `aeroloom check` was run into the folder.
"""
import argparse
import json
import math
import pathlib
import re
import sys

import numpy
import vtk
from vtkmodules.util.numpy_support import vtk_to_numpy

STATIONS, NEAREST, THICKEST = 41, 8, 0.4
#          factor, fraction of the chord, cells across a trailing edge
LEVELS = {"A": (1.5, 0.00225, 4), "B": (1, 0.0015, 6), "C": (2 / 3, 0.001, 9), "D": (0.5, 0.00075, 12)}


def read_surface(folder):
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(str(folder / "surface.pvtp"))
    reader.Update()
    surface = reader.GetOutput()
    # Parts of the file have points of their own.
    points, number = numpy.unique(vtk_to_numpy(surface.GetPoints().GetData()), axis=0, return_inverse=True)
    return points, number.ravel()[vtk_to_numpy(surface.GetPolys().GetConnectivityArray())].reshape(-1, 3)


def components(edges):
    """A number for each triangle (row of edge numbers), equal where a chain of common edges leads from one to the other."""
    parent = list(range(len(edges)))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    user = {}
    for i, row in enumerate(edges.tolist()):
        for edge in row:
            parent[root(i)] = root(user.setdefault(edge, i))
    return numpy.unique([root(i) for i in range(len(edges))], return_inverse=True)[1]



def sections(points, triangles, axis, value):
    """Of each closed section: places in the plane, by triangle, and the mean edges of these triangles."""
    above = points[:, axis] > value
    some = above[triangles].sum(axis=1)
    cut = triangles[(some > 0) & (some < 3)]
    if len(cut) == 0:
        return
    pairs = numpy.sort(cut[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    crossed = above[pairs[:, :, 0]] != above[pairs[:, :, 1]]
    pairs = pairs[crossed].reshape(-1, 2, 2)
    number = components(pairs[:, :, 0] * len(points) + pairs[:, :, 1])
    ends = points[pairs]
    part = (value - ends[:, :, 0, axis]) / (ends[:, :, 1, axis] - ends[:, :, 0, axis])
    places = ends[:, :, 0] + part[:, :, None] * (ends[:, :, 1] - ends[:, :, 0])
    corners = points[cut]
    sizes = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).mean(axis=1)
    for c in range(number.max() + 1):
        yield places[number == c], sizes[number == c]


def measure(places, sizes, level, axis):
    """Chord, and the ratios of spacings to those asked for, at leading and trailing edge."""
    _, fraction, cells = LEVELS[level]
    flat = places.reshape(-1, 3)
    low, high = flat.min(axis=0), flat.max(axis=0)
    chord, thickness = high[0] - low[0], (high - low)[3 - axis]
    if thickness > THICKEST * chord:
        return None
    behind = flat[flat[:, 0] > high[0] - 1e-3 * chord][:, 3 - axis]
    width = behind.max() - behind.min()
    asked = {"leading": fraction * chord, "trailing": fraction * chord}
    if 1e-4 * chord < width < cells * fraction * chord:
        asked["trailing"] = width / cells
    ratios = {}
    for name, end in (("leading", flat[flat[:, 0].argmin()]), ("trailing", flat[flat[:, 0].argmax()])):
        away = numpy.linalg.norm(places.mean(axis=1) - end, axis=1)
        ratios[name] = sizes[numpy.argsort(away, kind="stable")[:NEAREST]].mean() / asked[name]
    return chord, ratios


def spacings(folder, level, cuts):
    """Medians of ratios by body and end."""
    points, triangles = read_surface(folder)
    far = numpy.ptp(points[:, 0])
    found = {}
    for axis, begin, end in cuts:
        for value in numpy.linspace(begin, end, STATIONS):
            lifting = [m for m in (measure(*s, level, axis) for s in sections(points, triangles, axis, value)) if m]
            lifting = sorted((m for m in lifting if m[0] < 0.5 * far), key=lambda m: -m[0])
            for i, (_, ratios) in enumerate(lifting):
                body = "wing" if axis == 1 and i == 0 else "others"
                for name, ratio in ratios.items():
                    found.setdefault((body, name), []).append(ratio)
    return {key: (float(numpy.median(values)), len(values)) for key, values in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cut", nargs=3, action="append", required=True, metavar=("AXIS", "FROM", "TO"))
    parser.add_argument("outputs", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    cuts = [("xyz".index(axis), float(begin), float(end)) for axis, begin, end in arguments.cut]
    print("| level | tetrahedra | over forecast | over the cube | wing: leading | trailing | others: leading | trailing | "
          "edges 0.71–1.41 | 0.5–2 | angle | s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    before = None
    for folder in arguments.outputs:
        report = json.loads((folder / "report.json").read_text())
        level, count = re.search(r"^  level: (\w+)", report["configuration"], re.MULTILINE)[1], report["mesh"]["tetrahedra"]
        check = folder / "check.json"
        forecast = f"{count / json.loads(check.read_text())['forecast']['tetrahedra']:.2f}" if check.exists() else "–"
        found = spacings(folder, level, cuts)
        cube = "–" if before is None else f"{count / before[1] / (before[0] / LEVELS[level][0]) ** 3:.2f}"
        before = LEVELS[level][0], count
        ratios = [f"{found[key][0]:.2f} ({found[key][1]})" if key in found else "–"
                  for key in (("wing", "leading"), ("wing", "trailing"), ("others", "leading"), ("others", "trailing"))]
        near = ' | '.join(f"{100 * report['volume'].get(key, math.nan):.1f} %" for key in ('good_edges', 'fair_edges'))
        print(f"| {level} | {count:,} | {forecast} | {cube} | {' | '.join(ratios)} | {near} | "
              f"{report['quality']['min_dihedral_deg']:.1f} | {sum(stage['wall_seconds'] for stage in report['stages']):.0f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
