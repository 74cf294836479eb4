"""What the oracles of solver files share: the mesh that is in them, and what must hold of what is read.

The mesh is that of tests/io/mixed_mesh.hpp with 4 by 4 squares.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

COUNTS = {"tetra": 104, "pyramid": 20, "wedge": 32, "hexahedron": 4}
POINTS = 25 * 3 + 10 + 4 + 10
VOLUME = 40 * (2 * 1.5 + 0.25 * 0.125 * 0.0625)
# Triangles and quadrilaterals by patch. The wall below has the prisms' bases, the cubes' and the hexahedra's; the
# plane of symmetry two triangles a square above prisms and a cube; far away: sides x = 0 and y = 4, the top of both
# slabs' parts, the cubes' split sides and the upper slab's side above them, sides, tops and both ends of the hexahedra.
PATCHES = [(2 * 16, 4 + 4), (2 * 4, 4 + 1), (2 * 4 + 2 * 4 + 2 * 16 + 2 * 4 + 2 * 4, 4 + 1 + 4 + 4 + 4 + 2)]
# Faces of cells with normals outward, of the convention that CGNS has; and where corner k of it stands in VTK's.
FACES = {
    "tetra": [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}
VTK_WEDGE = [0, 2, 1, 3, 5, 4]


def below(points, faces):
    """Volumes between faces and the origin, by the divergence integral."""
    a, volume = points[faces[:, 0]], np.zeros(len(faces))
    for k in range(1, faces.shape[1] - 1):
        b, c = points[faces[:, k]] - a, points[faces[:, k + 1]] - a
        volume += np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return volume


def check(what, points, cells, patches):
    """`cells` by meshio's name of the shape in CGNS order, `patches` a list of (triangles, quadrilaterals) that
    point into the fluid."""
    assert len(points) == POINTS, (what, len(points))
    total = 0
    for shape, count in COUNTS.items():
        assert len(cells[shape]) == count, (what, shape, len(cells[shape]))
        volumes = sum(below(points, cells[shape][:, face]) for face in FACES[shape])
        assert volumes.min() > 0, (what, shape, volumes.min())
        total += volumes.sum()
    assert abs(total - VOLUME) < 1e-9, (what, total, VOLUME)
    assert [(len(t), len(q)) for t, q in patches] == PATCHES, (what, [(len(t), len(q)) for t, q in patches])
    enclosed = sum(below(points, faces).sum() for patch in patches for faces in patch if len(faces))
    assert abs(enclosed + VOLUME) < 1e-9, (what, enclosed)
    print(f"{what}: {POINTS} points, {sum(COUNTS.values())} cells of volume {total}, {len(patches)} patches")


def run(checks):
    """Has the program named on the command line write its files to a folder, and calls check(folder) for each."""
    with tempfile.TemporaryDirectory() as name:
        subprocess.run([*sys.argv[1:], name], check=True)
        for function in checks:
            function(pathlib.Path(name))
