#!/usr/bin/env python3
"""Tetrahedra with two or more faces on the boundary, in meshes as written (.pvtu, .vtu).

usage: corners.py MESH ... [--places N] [--page FILE]

Such a tetrahedron fills the angle between two of its faces on the boundary alone. `forced`: that angle, degrees, is below
twice the target (--target, 28), so that no two of the target's angle fit; `narrow`: it is below 70. `shared faces`
between two regions count as boundary. Needs the system's python with VTK and numpy.
"""
import argparse

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from printed_table import PrintedTable, add_page_option

FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # opposite to each corner
TETRAHEDRON = 10


def read(name):
    """Points (n,3), tetrahedra (m,4), coinciding points of parts made one, and the region of each."""
    reader = vtk.vtkXMLPUnstructuredGridReader() if name.endswith(".pvtu") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    tets = cells[offsets[:-1][types == TETRAHEDRON][:, None] + np.arange(4)]
    region = grid.GetCellData().GetArray("region")
    regions = vtk_to_numpy(region)[types == TETRAHEDRON] if region else np.zeros(len(tets), int)
    points, same = np.unique(points, axis=0, return_inverse=True)
    return points, same.reshape(-1)[tets], regions


def boundary_sides(tets, regions):
    """(m,4): whether the face opposite to each corner is on the boundary, or between regions."""
    keys = np.sort(np.concatenate([tets[:, face] for face in FACES]), axis=1).astype(np.uint64)
    mixed = (keys[:, 0] << np.uint64(42)) ^ (keys[:, 1] << np.uint64(21)) ^ keys[:, 2]
    order = np.lexsort((keys[:, 2], mixed))
    same = (keys[order][1:] == keys[order][:-1]).all(axis=1)
    owner = np.tile(np.arange(len(tets)), 4)[order]
    inner = same & (regions[owner[1:]] == regions[owner[:-1]])
    paired = np.zeros(len(keys), bool)
    paired[order[1:][inner]] = paired[order[:-1][inner]] = True
    return ~paired.reshape(4, len(tets)).T


def dihedrals(points):
    """(m,4,4): the angles of tetrahedra (m,4,3) between the faces opposite to two corners, degrees."""
    normals = []
    for face in FACES:
        a, b, c = (points[:, k] for k in face)
        n = np.cross(b - a, c - a)
        normals.append(n / np.linalg.norm(n, axis=1)[:, None])
    n = np.stack(normals, axis=1)
    return np.degrees(np.arccos(np.clip(-np.einsum("mik,mjk->mij", n, n), -1, 1)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--target", type=float, default=28)
    parser.add_argument("--places", type=int, default=0, help="print so many that are not forced")
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Tetrahedra with several faces on the boundary", ("mesh", "tetrahedra", "least angle", "several faces", "forced",
                                                                           "narrow", "others"))
    places = []
    for name in options.meshes:
        points, tets, regions = read(name)
        sides = boundary_sides(tets, regions)
        least = 180.0
        for begin in range(0, len(tets), 500000):
            angles = dihedrals(points[tets[begin:begin + 500000]])
            least = min(least, np.where(np.eye(4, dtype=bool), 180, angles).min())
        several = np.flatnonzero(sides.sum(axis=1) > 1)
        angles = dihedrals(points[tets[several]])
        pairs = sides[several][:, :, None] & sides[several][:, None, :] & ~np.eye(4, dtype=bool)
        wedge = np.where(pairs, angles, 180).min(axis=(1, 2)) if len(several) else np.zeros(0)
        forced, narrow = wedge < 2 * options.target, wedge < 70
        table.add(name, f"{len(tets):,}", f"{least:.2f}", len(several), forced.sum(), (narrow & ~forced).sum(),
                  (~narrow & ~forced).sum())
        for i in np.flatnonzero(~forced)[:options.places]:
            place = points[tets[several[i]]].mean(axis=0)
            own = np.where(np.eye(4, dtype=bool), 180, angles[i]).min()
            places.append(f"{name}: {sides[several[i]].sum()} faces, wedge {wedge[i]:.1f}, least angle {own:.1f}, at "
                          f"{place[0]:.8g} {place[1]:.8g} {place[2]:.8g}")
    table.save(options.page)
    if places:
        print("\n" + "\n".join(places))


if __name__ == "__main__":
    main()
