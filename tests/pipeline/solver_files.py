"""What readers nobody here wrote make of the files of a run: counts, volume, patches, orientation.

Each function takes the output folder and the run's report.json and raises AssertionError; returns what it saw.
Where Debian has no reader (su2b, 64-bit UGRID) it is read here from the description of the format alone.
"""
import os
import pathlib
import re
import subprocess

import meshio
import numpy as np

LAUNCHER = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "mpirun_local.sh"


def volumes(points, tets):
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def flux(points, triangles):
    """Of the vectors from the origin: three times the volume inside where triangles look outward."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 2


def expect_mesh(report, points, tets, triangles, outward):
    mesh = report["mesh"]
    assert (len(points), len(tets), len(triangles)) == (mesh["points"], mesh["tetrahedra"], mesh["boundary_triangles"])
    signed = volumes(points, tets)
    assert signed.min() > 0, f"a tetrahedron has volume {signed.min()}"
    assert abs(signed.sum() / mesh["volume"] - 1) < 1e-9
    assert abs(flux(points, triangles) * outward / (3 * mesh["volume"]) - 1) < 1e-9, "boundary faces look the wrong way"
    return f"{len(tets)} tetrahedra, {len(triangles)} triangles"


def expect_patches(report, counts, longest=None):
    """`longest`: letters of a name that the format keeps."""
    wanted = {patch["name"][:longest]: patch["triangles"] for patch in report["patches"]}
    assert counts == wanted, f"{counts} instead of {wanted}"


def by_id(report, ids, first=1):
    names = [patch["name"] for patch in report["patches"]]
    return {name: int((ids == i + first).sum()) for i, name in enumerate(names)}


def vtk_grid(reader, path):
    from vtk.util.numpy_support import vtk_to_numpy
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    ids = vtk_to_numpy(grid.GetPointData().GetArray("global_id"))
    points = np.zeros((ids.max() + 1, 3))
    points[ids] = vtk_to_numpy(grid.GetPoints().GetData())
    return grid, points, ids[vtk_to_numpy(grid.GetCells().GetConnectivityArray())]


def vtk_readers(volume, surface, volume_path, surface_path, report):
    from vtk.util.numpy_support import vtk_to_numpy
    grid, points, corners = vtk_grid(volume, volume_path)
    assert {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())} == {10}
    boundary, _, triangles = vtk_grid(surface, surface_path)
    names = boundary.GetFieldData().GetAbstractArray("patch_names")
    patch = vtk_to_numpy(boundary.GetCellData().GetArray("patch"))
    counts = {names.GetValue(i): int((patch == i).sum()) for i in range(names.GetNumberOfValues())}
    expect_patches(report, counts)
    return expect_mesh(report, points, corners.reshape(-1, 4), triangles.reshape(-1, 3), 1)


def check_vtkhdf(folder, report):
    import vtk
    return vtk_readers(vtk.vtkHDFReader(), vtk.vtkHDFReader(), folder / "mesh.vtkhdf", folder / "mesh_surface.vtkhdf",
                       report)


def check_vtu(folder, report):
    import vtk
    grid, points, corners = vtk_grid(vtk.vtkXMLPUnstructuredGridReader(), folder / "mesh.pvtu")
    assert grid.GetNumberOfCells() == report["mesh"]["tetrahedra"] and len(points) == report["mesh"]["points"]
    assert abs(volumes(points, corners.reshape(-1, 4)).sum() / report["mesh"]["volume"] - 1) < 1e-9
    return f"{grid.GetNumberOfCells()} tetrahedra"


def check_cgns(folder, report):
    done = subprocess.run(["cgnscheck", folder / "mesh.cgns"], capture_output=True, text=True, timeout=300)
    text = done.stdout + done.stderr
    assert done.returncode == 0 and "ERROR" not in text and "WARNING" not in text, text[-3000:]
    for patch in report["patches"]:
        assert f'checking BC "{patch["name"][:32]}"' in text, patch["name"]
    import h5py
    with h5py.File(folder / "mesh.cgns") as file:
        zone = file["Base/Zone"]
        points = np.stack([zone[f"GridCoordinates/Coordinate{axis}/ data"][:] for axis in "XYZ"], axis=1)
        sections = {name: node[" data"][0] for name, node in zone.items() if node.attrs.get("label") == b"Elements_t"}
        corners = {name: zone[name]["ElementConnectivity/ data"][:].astype(np.int64) - 1 for name in sections}
    tets = np.concatenate([corners[n].reshape(-1, 4) for n, kind in sections.items() if kind == 10])
    triangles = np.concatenate([corners[n].reshape(-1, 3) for n, kind in sections.items() if kind == 5])
    expect_patches(report, {n: len(corners[n]) // 3 for n, kind in sections.items() if kind == 5}, 32)
    return "cgnscheck without a complaint, " + expect_mesh(report, points, tets, triangles, 1)


def check_ugrid(folder, report):
    mesh = meshio.read(folder / "mesh.lb8.ugrid")
    cells = mesh.cells_dict
    expect_patches(report, by_id(report, mesh.cell_data_dict["ugrid:ref"]["triangle"]))
    return "meshio: " + expect_mesh(report, mesh.points, cells["tetra"], cells["triangle"], -1)


def check_ugrid64(folder, report):
    data = (folder / "mesh.lb8l.ugrid").read_bytes()
    n = np.frombuffer(data, "<i8", 7)
    assert n[2] == 0 and not n[4:].any()
    at = 56
    points = np.frombuffer(data, "<f8", 3 * n[0], at).reshape(-1, 3)
    at += 24 * n[0]
    triangles = np.frombuffer(data, "<i8", 3 * n[1], at).reshape(-1, 3) - 1
    at += 24 * n[1]
    expect_patches(report, by_id(report, np.frombuffer(data, "<i8", n[1], at)))
    tets = np.frombuffer(data, "<i8", 4 * n[3], at + 8 * n[1]).reshape(-1, 4) - 1
    return "by the specification: " + expect_mesh(report, points, tets, triangles, -1)


def check_su2(folder, report):
    mesh = meshio.read(folder / "mesh.su2")
    triangles = np.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
    tets = np.concatenate([block.data for block in mesh.cells if block.type == "tetra"])
    markers = re.findall(r"MARKER_TAG= (\S+)\s+MARKER_ELEMS= (\d+)", (folder / "mesh.su2").read_text())
    expect_patches(report, {name: int(count) for name, count in markers}, 32)
    return "meshio: " + expect_mesh(report, mesh.points, tets, triangles, -1)


def check_su2b(folder, report):
    """By SU2's CSU2BinaryMeshReaderBase: 8-byte integers; per element type, corners, number."""
    data = (folder / "mesh.su2b").read_bytes()
    size, zones, _, dimension = np.frombuffer(data, "<i4", 4)
    assert (zones, dimension) == (1, 3) and size in (4, 8)
    integer, at = np.dtype(f"<i{size}"), 16

    def take(kind, count):
        nonlocal at
        values = np.frombuffer(data, kind, count, at)
        at += values.nbytes
        return values

    def table():
        count = int(take(integer, 1)[0])
        return np.diff(take(integer, count + 1)), count

    lengths, count = table()
    assert (lengths == 6).all()
    elements = take(integer, 6 * count).reshape(-1, 6)
    assert (elements[:, 0] == 10).all()
    rows = int(take(integer, 1)[0])
    points = take(np.dtype([("x", "<f8", 3), ("id", integer)]), rows)
    triangles, names = [], {}
    for _ in range(int(take("<i4", 1)[0])):
        name = take("S33", 1)[0].decode()
        lengths, count = table()
        block = take(integer, int(lengths.sum())).reshape(count, -1)
        names[name] = count
        triangles.append(block[:, 1:4])
    assert at == len(data)
    expect_patches(report, names, 32)
    return "by SU2's reader: " + expect_mesh(report, points["x"], elements[:, 1:5].astype(np.int64),
                                             np.concatenate(triangles).astype(np.int64), -1)


def check_meshb(folder, report):
    mesh = meshio.read(folder / "mesh.meshb")
    cells = mesh.cells_dict
    expect_patches(report, by_id(report, mesh.cell_data_dict["medit:ref"]["triangle"]))
    return "meshio: " + expect_mesh(report, mesh.points, cells["tetra"], cells["triangle"], 1)


def check_msh(folder, report):
    mesh = meshio.read(folder / "mesh.msh")
    names = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
    group = mesh.cell_data_dict["gmsh:physical"]["triangle"]
    expect_patches(report, {names[tag]: int((group == tag).sum()) for tag in names})
    done = subprocess.run(["gmsh", "-check", "-v", "3", folder / "mesh.msh"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and "rror" not in done.stdout + done.stderr, done.stdout + done.stderr
    cells = mesh.cells_dict
    return "gmsh, meshio: " + expect_mesh(report, mesh.points, cells["tetra"], cells["triangle"], 1)


def check_msh_parts(folder, report):
    """Gmsh puts the parts together again."""
    parts = sorted(folder.glob("mesh_*.msh"))
    whole = folder / "joined.mesh"
    done = subprocess.run(["gmsh", *parts, "-save_all", "-0", "-format", "mesh", "-o", whole],
                          capture_output=True, text=True, timeout=600)
    assert done.returncode == 0 and whole.exists(), done.stdout + done.stderr
    mesh = meshio.read(whole)
    assert len(mesh.cells_dict["tetra"]) == report["mesh"]["tetrahedra"]
    assert len(mesh.cells_dict["triangle"]) == report["mesh"]["boundary_triangles"]
    assert len(np.unique(mesh.points, axis=0)) == report["mesh"]["points"]  # each part brings those on its border
    return f"gmsh: {len(parts)} parts, {len(mesh.cells_dict['tetra'])} tetrahedra"


def check_openfoam(folder, report):
    case = folder / "openfoam"
    ranks = len(list(case.glob("processor*")))
    environment = os.environ | {"WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}
    command = [LAUNCHER, str(ranks), "checkMesh", "-parallel"] if ranks > 1 else ["checkMesh"]
    done = subprocess.run(command, cwd=case, env=environment, capture_output=True, text=True, timeout=600)
    text = done.stdout + done.stderr
    assert done.returncode == 0 and "Mesh OK." in text, text[-4000:]
    assert re.search(rf"cells: +{report['mesh']['tetrahedra']}\n", text)
    for patch in report["patches"]:
        # Whose name is that of a group is called otherwise.
        assert re.search(rf"\b{re.escape(patch['name'])}(_patch)? *{patch['triangles']} ", text), patch["name"]
    return f"checkMesh on {ranks} rank(s): Mesh OK"


CHECKS = {"vtu": check_vtu, "vtkhdf": check_vtkhdf, "cgns": check_cgns, "ugrid": check_ugrid, "ugrid64": check_ugrid64,
          "su2": check_su2, "su2b": check_su2b, "msh": check_msh, "msh_parts": check_msh_parts, "meshb": check_meshb,
          "openfoam": check_openfoam}
