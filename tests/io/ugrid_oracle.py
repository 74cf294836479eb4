#!/usr/bin/env python3
"""Others read our UGRID files: meshio (.lb8, .b8 and the 64-bit kinds), aflr3_to_cgns and cgnscheck (.b8), and a
reader written from the UG_IO documentation alone.

usage: ugrid_oracle.py COMMAND...    (writes the files to the folder given as its last argument)
"""
import re
import shutil
import subprocess

import numpy as np

import solver_oracle

# Integer and real types by suffix.
KINDS = {"lb8": ("<i4", "<f8"), "b8": (">i4", ">f8"), "lb8l": ("<i8", "<f8"), "b8l": (">i8", ">f8")}
# UG_IO: the base of a pyramid is 1, 4, 5, 2 seen from its apex 3.
BASE_AND_APEX = [0, 3, 4, 1, 2]
NAMES = ["wing___lower_side", "symmetry", "far_field"]


def split(faces, ids):
    return [[f[i == patch + 1] for f, i in zip(faces, ids)] for patch in range(len(solver_oracle.PATCHES))]


def by_specification(folder):
    for suffix, (integer, real) in KINDS.items():
        with open(folder / f"mixed.{suffix}.ugrid", "rb") as file:
            counts = np.fromfile(file, integer, 7)
            points = np.fromfile(file, real, 3 * counts[0]).reshape(-1, 3)
            faces = [np.fromfile(file, integer, n * k).reshape(-1, k) - 1 for n, k in ((counts[1], 3), (counts[2], 4))]
            ids = [np.fromfile(file, integer, n) for n in counts[1:3]]
            tets, pyramids, prisms, hexahedra = (
                np.fromfile(file, integer, n * k).reshape(-1, k) - 1 for n, k in zip(counts[3:7], (4, 5, 6, 8)))
            assert not file.read(1), suffix
        for of_shape in ids:
            assert (np.diff(of_shape) >= 0).all(), "faces are sorted by patch"
        cells = {"tetra": tets, "pyramid": pyramids[:, BASE_AND_APEX], "wedge": prisms, "hexahedron": hexahedra}
        solver_oracle.check(f"specification {suffix}", points, cells, split(faces, ids))


def by_meshio(folder):
    import meshio

    for suffix in KINDS:
        mesh = meshio.read(folder / f"mixed.{suffix}.ugrid")
        blocks = {block.type: block.data for block in mesh.cells}
        ids = {block.type: id for block, id in zip(mesh.cells, mesh.cell_data["ugrid:ref"])}
        faces = [blocks["triangle"], blocks["quad"]]
        patches = split(faces, [ids["triangle"], ids["quad"]])
        # meshio takes pyramids to its own order and leaves prisms in UGRID's.
        solver_oracle.check(f"meshio {suffix}", mesh.points, blocks, patches)


def by_aflr3_to_cgns(folder):
    if not shutil.which("aflr3_to_cgns") or not shutil.which("cgnscheck"):
        print("aflr3_to_cgns or cgnscheck is not here: left out")
        return
    cgns = folder / "mixed.cgns"
    subprocess.run(["aflr3_to_cgns", folder / "mixed.b8.ugrid", cgns], check=True, stdout=subprocess.PIPE)
    found = subprocess.run(["cgnscheck", "-v", cgns], check=True, stdout=subprocess.PIPE, text=True).stdout
    assert "ERROR" not in found, found
    assert "Vertex Size=[99]" in found and "Cell Size=[160]" in found, found
    faces = re.findall(r"\[internal,external\] Faces=\[(\d+),(\d+)\]", found)
    wanted = [("0", str(patch[shape])) for shape in range(2) for patch in solver_oracle.PATCHES]
    assert faces == wanted, faces  # all of them are faces of one cell
    print("aflr3_to_cgns and cgnscheck: no errors")


def mapbc(folder):
    lines = (folder / "mixed.mapbc").read_text().split("\n")
    assert lines[0] == "3" and lines[4] == "", lines
    rows = [line.split() for line in lines[1:4]]
    assert [row[0] for row in rows] == ["1", "2", "3"] and [row[2] for row in rows] == NAMES, rows
    assert [row[1] for row in rows] == ["4000", "3000", "5000"], rows


if __name__ == "__main__":
    solver_oracle.run([by_specification, by_meshio, by_aflr3_to_cgns, mapbc])
