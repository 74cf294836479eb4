#!/usr/bin/env python3
"""Others read our SU2 files: meshio the text, a reader written from the format's description alone (the layout that
SU2's CSU2BinaryMeshReaderBase reads) the binary one.

usage: su2_oracle.py COMMAND...    (writes the files to the folder given as its last argument)
"""
import numpy as np

import solver_oracle

NAMES = ["wing___lower_side", "symmetry", "far_field"]
SHAPES = {10: ("tetra", 4), 14: ("pyramid", 5), 13: ("wedge", 6), 12: ("hexahedron", 8)}


def by_meshio(folder):
    import meshio

    mesh = meshio.read(folder / "mixed.su2")
    tags = mesh.cell_data["su2:tag"]
    cells = {b.type: b.data for b in mesh.cells if b.type in solver_oracle.COUNTS}
    cells["wedge"] = cells["wedge"][:, solver_oracle.VTK_WEDGE]
    faces = {b.type: (b.data, tag) for b, tag in zip(mesh.cells, tags) if b.type in ("triangle", "quad")}
    patches = [[faces[shape][0][faces[shape][1] == k + 1] for shape in ("triangle", "quad")] for k in range(3)]
    solver_oracle.check("meshio", mesh.points, cells, patches)


def read_elements(file, integer, last):
    """(type, points, last integer) of each element of a section."""
    count = np.fromfile(file, integer, 1)[0]
    places = np.fromfile(file, integer, count + 1)
    assert places[0] == 0 and (np.diff(places.astype(np.int64)) > 0).all()
    data = np.fromfile(file, integer, places[-1])
    items = [data[a:b].astype(np.int64) for a, b in zip(places[:-1], places[1:])]
    return [(item[0], item[1:len(item) - last], item[-1]) for item in items]


def by_description(folder):
    with open(folder / "mixed.su2b", "rb") as file:
        width = np.fromfile(file, "<i4", 1)[0]
        integer = {4: "<u4", 8: "<u8"}[width]
        zones, _, dimensions = np.fromfile(file, "<i4", 3)
        assert (zones, dimensions) == (1, 3)
        elements = read_elements(file, integer, 1)
        assert [e[2] for e in elements] == list(range(len(elements))), "cells are numbered in turn"
        count = np.fromfile(file, integer, 1)[0]
        rows = np.fromfile(file, np.dtype([("xyz", "<f8", 3), ("index", integer)]), count)
        assert (rows["index"] == np.arange(count)).all()
        names, patches = [], []
        for _ in range(np.fromfile(file, "<i4", 1)[0]):
            name = file.read(33)
            assert name[-1] == 0
            names.append(name.rstrip(b"\0").decode())
            faces = read_elements(file, integer, 0)
            patches.append([np.array([p for t, p, _ in faces if t == type]) for type in (5, 9)])
        assert not file.read(1)
    assert names == NAMES, names
    cells = {name: np.array([p for t, p, _ in elements if t == type]) for type, (name, _) in SHAPES.items()}
    cells["wedge"] = cells["wedge"][:, solver_oracle.VTK_WEDGE]
    solver_oracle.check("description, binary", rows["xyz"], cells, patches)


def text_names(folder):
    lines = (folder / "mixed.su2").read_text().splitlines()
    assert [line.split("= ")[1] for line in lines if line.startswith("MARKER_TAG")] == NAMES
    configuration = (folder / "mixed_markers.cfg").read_text()
    assert all(name in configuration for name in NAMES)


if __name__ == "__main__":
    solver_oracle.run([by_meshio, by_description, text_names])
