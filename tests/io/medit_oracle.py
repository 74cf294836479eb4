#!/usr/bin/env python3
"""Has meshio and gmsh read the Medit files of the mixed mesh. usage: medit_oracle.py SAMPLE_PROGRAM"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy as np
except ImportError:
    print("meshio is not installed")
    sys.exit(77)

EXPECTED = {"tetra": 104, "pyramid": 20, "wedge": 32, "hexahedron": 4}


def corner_volumes(shape, p):
    """Six times the volumes of tetrahedra at corners, positive in the format's order of corners."""
    tets = {"tetra": [(0, 1, 2, 3)],
            "pyramid": [(0, 1, 2, 4), (0, 2, 3, 4), (0, 1, 3, 4), (1, 2, 3, 4)],
            "wedge": [(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 2, 5), (0, 4, 5, 3), (1, 5, 3, 4)],
            "hexahedron": [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (6, 5, 7, 2)]}[shape]
    for a, b, c, d in tets:
        yield np.einsum("ij,ij->i", np.cross(p[:, b] - p[:, a], p[:, c] - p[:, a]), p[:, d] - p[:, a])


def check_meshio(path, exact):
    mesh = meshio.read(path)
    counts, refs, faces = {}, {}, {}
    boundary, volume = 0.0, 0.0
    for block, references in zip(mesh.cells, mesh.cell_data["medit:ref"]):
        counts[block.type] = len(block.data)
        refs[block.type] = set(np.unique(references).tolist())
        p = mesh.points[block.data]
        if block.type in EXPECTED:
            for six_volumes in corner_volumes(block.type, p):
                assert (six_volumes > 0).all(), (path, block.type)
            continue
        # Outward triangles enclose the volume; the interface of regions (reference 4) does not count.
        outer = p[references != 4]
        faces[block.type] = len(outer)
        for k in range(2, outer.shape[1]):
            boundary += np.einsum("ij,ij->i", np.cross(outer[:, 0], outer[:, k - 1]), outer[:, k]).sum() / 6
    for shape, count in EXPECTED.items():
        assert counts[shape] == count, (path, counts)
    assert refs["tetra"] == {1, 2} and refs["wedge"] == {1} and refs["pyramid"] == {1}, refs
    assert refs["triangle"] == {1, 2, 3, 4}, refs
    # Two slabs of 4 x 4 x 1, a row of 4 cubes and one of 4 hexahedra, under a map with determinant 3 - 1/64.
    determinant = 2 * (1.5 * 1 - 0) - 0.25 * (0 * 1 - 0.125 * 0.0625)
    assert abs(boundary - 40 * determinant) < 1e-9, (path, boundary, 40 * determinant)
    assert exact is None or (exact.points == mesh.points).all(), path
    print(path.name, counts, "volume", boundary)
    return mesh


def check_gmsh(path):
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        return print("gmsh is not installed")
    # This one knows tetrahedra, triangles and quadrilaterals of Medit files.
    out = path.parent / "from_gmsh.msh"
    run = subprocess.run([gmsh, "-save", "-format", "msh2", "-o", str(out), str(path)], capture_output=True, text=True,
                         timeout=60)
    assert run.returncode == 0 and "Error" not in run.stdout + run.stderr, run.stdout + run.stderr
    mesh = meshio.read(out)
    print("gmsh", {block.type: len(block.data) for block in mesh.cells})
    tets = sum(len(block.data) for block in mesh.cells if block.type == "tetra")
    assert tets == EXPECTED["tetra"], tets


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], name], check=True, timeout=60)
        narrow = check_meshio(folder / "narrow.meshb", None)
        check_meshio(folder / "wide.meshb", narrow)
        check_meshio(folder / "text.mesh", narrow)
        check_gmsh(folder / "text.mesh")
        print((folder / "narrow.names").read_text())


main()
