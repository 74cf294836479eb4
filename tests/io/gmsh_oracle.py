#!/usr/bin/env python3
"""What Gmsh and meshio make of MSH files of the mixed mesh, and what read_msh makes of Gmsh's own.

usage: gmsh_oracle.py WRITE_GMSH_OPENFOAM AEROLOOM
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy
except ImportError:
    sys.exit(77)

CELLS = {"tetra": 104, "pyramid": 20, "wedge": 32, "hexahedron": 4}
PATCHES = {"wing / lower side": 40, "symmetry": 13, "far field": 83, "interface": 32}
REGIONS = {"lower layer": 64, "upper": 96}
# Faces of a cell in Gmsh's order, outward.
FACES = {"tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
         "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
         "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
         "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}


def gmsh(*arguments):
    result = subprocess.run(["gmsh", *map(str, arguments)], capture_output=True, text=True, timeout=60)
    text = result.stdout + result.stderr
    assert result.returncode == 0 and "Error" not in text, text
    return text


def volume(points, corners):
    """Volumes of closed fans of triangles about their first corner."""
    a = points[corners[:, 0]]
    return sum(numpy.einsum("ij,ij->i", a, numpy.cross(points[corners[:, k]] - a, points[corners[:, k + 1]] - a))
               for k in range(1, corners.shape[1] - 1)) / 6


def check_with_meshio(path):
    mesh = meshio.read(path)
    counts, groups, total = {}, {}, 0
    names = {(int(dimension), int(tag)): name for name, (tag, dimension) in mesh.field_data.items()}
    boundary = 0
    for block, physical in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
        dimension = 2 if block.type in ("triangle", "quad") else 3
        for tag in physical:
            groups[names[dimension, int(tag)]] = groups.get(names[dimension, int(tag)], 0) + 1
        if dimension == 3:
            volumes = sum(volume(mesh.points, block.data[:, face]) for face in FACES[block.type])
            assert (volumes > 0).all(), f"{path}: a {block.type} is turned over"
            total += volumes.sum()
        elif names[2, int(physical[0])] != "interface":
            boundary += volume(mesh.points, block.data).sum()
    assert {name: counts.get(name) for name in CELLS} == CELLS, counts
    assert groups == PATCHES | REGIONS, groups
    assert abs(total - 40 * (2 * 1.5 + 0.25 * 0.125 * 0.0625)) < 1e-9, total
    assert abs(boundary - total) < 1e-9, f"boundary faces look inward: {boundary}, {total}"


def count_in_msh2(path, section):
    return int(re.search(rf"^\${section}\n(\d+)", path.read_text(errors="replace"), re.M).group(1))


GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 0.4;
"""
GROUPS = """Physical Volume("fluid in box", 7) = {1};
Physical Surface("left side", 11) = {1};
Physical Surface("rest", 12) = {2:6};
"""


def check_reading(program, folder):
    """Meshes of Gmsh's own, whole and partitioned, text and binary."""
    (folder / "groups.geo").write_text(GEOMETRY + GROUPS)
    (folder / "plain.geo").write_text(GEOMETRY)
    parts = ["-part", "3", "-part_split"]
    for geometry, name, options, patches in (
            ("groups", "text.msh", [], 2), ("groups", "binary.msh", ["-bin"], 2), ("plain", "plain.msh", [], 6),
            ("groups", "parametric.msh", ["-save_parametric"], 2), ("groups", "together.msh", ["-part", "3"], 2),
            ("groups", "parts.msh", parts, 2), ("groups", "ghosts.msh", [*parts, "-part_ghosts", "-bin"], 2),
            ("plain", "plain_parts.msh", [*parts, "-bin"], 6)):
        gmsh("-3", folder / f"{geometry}.geo", *options, "-o", folder / name, "-format", "msh41")
        path = folder / (name.replace(".msh", "_1.msh") if "-part_split" in options else name)
        result = subprocess.run([program, "convert", path, folder / "out.msh"], capture_output=True, text=True,
                                timeout=60)
        text = result.stdout + result.stderr
        found = re.search(r"read (\d+) points, (\d+) tetrahedra, .* 1 region\(s\), (\d+) patch\(es\)", text)
        assert result.returncode == 0 and found and "nothing to mend" in text, f"{name}: {text}"
        expected = count_of_gmsh(folder / f"{geometry}.geo")
        assert (int(found[1]), int(found[2]), int(found[3])) == (*expected, patches), f"{name}: {text}"


def count_of_gmsh(geometry):
    """Points and tetrahedra of the same geometry in format 2."""
    path = geometry.with_suffix(".msh2")
    if not path.exists():
        gmsh("-3", geometry, "-o", path, "-format", "msh2", "-save_all")
    lines = path.read_text().splitlines()
    begin = lines.index("$Elements")
    tetrahedra = sum(line.split()[1] == "4" for line in lines[begin + 2:lines.index("$EndElements")])
    return count_in_msh2(path, "Nodes"), tetrahedra


def main(writer, program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([writer, folder], check=True, timeout=60)
        check_with_meshio(folder / "mixed.msh")
        gmsh("-check", folder / "mixed.msh", "-0", "-o", folder / "checked.msh")
        gmsh(folder / "mixed.msh", "-0", "-o", folder / "mixed2.msh", "-format", "msh2")
        assert count_in_msh2(folder / "mixed2.msh", "Nodes") == 99
        assert count_in_msh2(folder / "mixed2.msh", "Elements") == 328
        # What Gmsh reads and writes again in text is the same mesh.
        gmsh(folder / "mixed.msh", "-0", "-o", folder / "again.msh", "-format", "msh41")
        check_with_meshio(folder / "again.msh")
        # All parts together have the elements of the whole, and the same groups.
        text = gmsh(*[folder / f"mixed_{part}.msh" for part in (1, 2, 3)], "-0", "-o", folder / "merged.msh",
                    "-format", "msh2")
        assert "3 partitions" in text, text
        assert count_in_msh2(folder / "merged.msh", "Elements") == 328
        check_reading(program, folder)
    print("Gmsh and meshio agree")


if __name__ == "__main__":
    if shutil.which("gmsh") is None:
        sys.exit(77)
    main(sys.argv[1], sys.argv[2])
