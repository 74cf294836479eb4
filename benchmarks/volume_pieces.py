#!/usr/bin/python3
"""The volume in pieces beside the volume in one piece, as Markdown tables.

usage: volume_pieces.py same PROGRAM CASE ... [--pieces N ...] [--ranks N ...] [--page FILE] [-- KEY=VALUE ...]
       volume_pieces.py cost PROGRAM CASE ... [--base PROGRAM] [--repeat N] [--page FILE] [-- KEY=VALUE ...]
       volume_pieces.py rate PROGRAM CASE ... [--repeat N] [--page FILE] [-- KEY=VALUE ...]

All runs are without improvement. Pieces are given by the tetrahedra wanted in one (volume.piece_tets).

same: the case in pieces of each size (default 60000, 250000 and 1000000000, which is one piece) on one rank. The
largest size is the reference: the difference counts the cells that only one of the two meshes has, a cell being the
coordinates of its vertices in every bit; "away" are cells that have no vertex on the surface or sharing a cell with
one that is. The second table is the quality of the reference; bad is a dihedral angle below 28 or above 138 degrees.
--ranks adds the hashes on so many ranks.

cost: wall seconds of the stages decompose and volume together, the least of N (default 3) interleaved repeats; CPU
seconds are those of tasks, contained children included. --base adds another program in one piece.

rate: decompose and volume in pieces of 250,000 on one rank beside the 3-D stage of Gmsh's HXT on one thread, the least
of N repeats. HXT fills the same surface mesh, with sizes extended from it or those of our mesh given as nested
regular grids, scaled until the numbers of tetrahedra are within 10 % of each other. What looking sizes up costs there
is measured in CPU seconds by looking them up twice. For domains of one region.

Needs the system's python3-vtk9 and python3-numpy; rate also gmsh.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from improvement import write_msh
from printed_table import PrintedTable, add_page_option

ROOT = pathlib.Path(__file__).resolve().parent.parent
ONE_PIECE = 1000000000


def run(program, case, ranks, piece_tets, settings, folder):
    settings = [f"output.directory={folder}", "improve.enabled=false", f"volume.piece_tets={piece_tets}", *settings]
    command = [ROOT / "scripts/mpirun_local.sh", str(ranks), os.path.abspath(program), "run", os.path.abspath(case)]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        sys.exit(f"{case} on {ranks} ranks ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads((pathlib.Path(folder) / "report.json").read_text())


def seconds_of_filling(report):
    """Wall and CPU seconds of the stages decompose and volume."""
    stages = [s for s in report["stages"] if s["name"] in ("decompose", "volume")]
    return (sum(s["wall_seconds"] for s in stages), sum(s["cpu_seconds_mean"] for s in stages) * report["ranks"])


def label(case):
    return pathlib.Path(case).stem


# ---- same ----------------------------------------------------------------------------------------------------------

@dataclasses.dataclass
class Mesh:
    points: np.ndarray  # (n, 3); vertices of several part files stand here several times
    cells: np.ndarray   # (m, 4) indices into points
    surface: np.ndarray  # (k, 3) points of the boundary of the regions


def read_mesh(folder):
    def read(reader, file):
        reader.SetFileName(str(file))
        reader.Update()
        return reader.GetOutput()

    mesh = read(vtk.vtkXMLPUnstructuredGridReader(), folder / "mesh.pvtu")
    surface = read(vtk.vtkXMLPPolyDataReader(), folder / "surface.pvtp")
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return Mesh(vtk_to_numpy(mesh.GetPoints().GetData()).copy(), cells.copy(),
                vtk_to_numpy(surface.GetPoints().GetData()).copy())


def number(*sets):
    """Numbers for the points of each set, equal where the coordinates are equal in every bit."""
    bits = np.ascontiguousarray(np.concatenate(sets)).view(np.uint64)
    order = np.lexsort(bits.T)
    differs = np.any(bits[order[1:]] != bits[order[:-1]], axis=1)
    numbers = np.empty(len(bits), np.int64)
    numbers[order] = np.concatenate(([0], np.cumsum(differs)))
    return np.split(numbers, np.cumsum([len(s) for s in sets])[:-1])


def lone_cells(a, b):
    """For the cells of each mesh, whether the other lacks it."""
    numbers = number(a.points, b.points)
    cells = np.concatenate([np.sort(n[m.cells], axis=1) for n, m in zip(numbers, (a, b))])
    order = np.lexsort(cells.T)
    rows = cells[order]
    starts = np.flatnonzero(np.concatenate(([True], np.any(rows[1:] != rows[:-1], axis=1))))
    signs = np.where(order < len(a.cells), 1, -1)
    unequal = np.add.reduceat(signs, starts) != 0
    lone = np.empty(len(cells), bool)
    lone[order] = np.repeat(unequal, np.diff(np.append(starts, len(cells))))
    return lone[:len(a.cells)], lone[len(a.cells):]


def away_from_surface(mesh):
    numbers, surface = number(mesh.points, mesh.surface)
    cells = numbers[mesh.cells]
    near = np.zeros(max(numbers.max(), surface.max()) + 1, bool)
    near[surface] = True
    near[cells[near[cells].any(axis=1)]] = True
    return ~near[cells].any(axis=1)


def shapes(mesh):
    """Smallest and largest dihedral angle in degrees, and mean ratio, of each cell."""
    smallest, largest, ratio = (np.empty(len(mesh.cells)) for _ in range(3))
    for first in range(0, len(mesh.cells), 200000):
        block = slice(first, first + 200000)
        p = [mesh.points[mesh.cells[block, k]] for k in range(4)]
        normals = [np.cross(p[b] - p[a], p[c] - p[a]) for a, b, c in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))]
        normals = [n / np.linalg.norm(n, axis=1)[:, None] for n in normals]
        pairs = [(a, b) for a in range(4) for b in range(a + 1, 4)]
        cosines = np.array([-np.sum(normals[a] * normals[b], axis=1) for a, b in pairs]).clip(-1, 1)
        smallest[block] = np.degrees(np.arccos(cosines.max(axis=0)))
        largest[block] = np.degrees(np.arccos(cosines.min(axis=0)))
        volume = np.abs(np.sum((p[1] - p[0]) * np.cross(p[2] - p[0], p[3] - p[0]), axis=1)) / 6
        ratio[block] = 12 * np.cbrt(3 * volume) ** 2 / sum(np.sum((p[a] - p[b]) ** 2, axis=1) for a, b in pairs)
    return smallest, largest, ratio


def quality_row(case, mesh, away):
    smallest, largest, ratio = shapes(mesh)
    bad = (smallest < 28) | (largest > 138)
    return (label(case), f"{len(mesh.cells):,}", f"{100 * bad.mean():.3f}", f"{away.sum():,}", f"{bad[away].sum():,}",
            f"{100 * bad[away].sum() / max(1, away.sum()):.4f}", f"{smallest.min():.2f}", f"{largest.max():.2f}",
            f"{ratio.mean():.4f}", f"{ratio[away].sum() / max(1, away.sum()):.4f}")


def same(options):
    table = PrintedTable("The same mesh in pieces as in one", (
        "case", "pieces of", "pieces", "tetrahedra", "difference", "per 100,000", "of it away",
        *(f"hash on {r}" for r in [1, *options.ranks])))
    qualities = []
    for case in options.cases:
        reference = None
        for piece_tets in sorted(options.pieces, reverse=True):
            with tempfile.TemporaryDirectory() as name:
                report = run(options.program, case, 1, piece_tets, options.settings, name)
                mesh = read_mesh(pathlib.Path(name))
            hashes = [report["mesh"]["hash"]]
            for ranks in options.ranks:
                with tempfile.TemporaryDirectory() as name:
                    hashes.append(run(options.program, case, ranks, piece_tets, options.settings, name)["mesh"]["hash"])
            away = away_from_surface(mesh)
            if reference is None:
                reference, reference_away, difference = mesh, away, ("–", "–", "–")
                qualities.append(quality_row(case, mesh, away))
            else:
                ours, theirs = lone_cells(reference, mesh)
                lone, lone_away = ours.sum() + theirs.sum(), (ours & reference_away).sum() + (theirs & away).sum()
                difference = (f"{lone:,}", f"{1e5 * lone / len(reference.cells):.1f}", f"{lone_away:,}")
            pieces = next(s["pieces"] for s in report["stages"] if s["name"] == "volume")
            table.add(label(case), f"{piece_tets:,}", pieces, f"{len(mesh.cells):,}", *difference, *(h[:8] for h in hashes))
    table.save(options.page)
    print()
    table = PrintedTable("Quality in one piece", ("largest pieces", "tetrahedra", "bad, %", "away", "bad away", "bad away, %", "smallest",
                                                  "largest", "mean ratio", "mean ratio away"))
    for row in qualities:
        table.add(*row)
    table.save(options.page)


# ---- cost ----------------------------------------------------------------------------------------------------------

def cost(options):
    kinds = [("one piece", options.program, 1, ONE_PIECE), ("250,000", options.program, 1, 250000),
             ("60,000", options.program, 1, 60000), ("250,000", options.program, 2, 250000)]
    if options.base:
        kinds.append(("one piece, base program", options.base, 1, ONE_PIECE))
    table = PrintedTable("What the overlap costs", ("case", "pieces of", "ranks", "pieces", "tetrahedra", "wall s", "of one piece's",
                                                    "CPU s", "of one piece's"))
    for case in options.cases:
        least = [(float("inf"), float("inf"))] * len(kinds)
        reports = [None] * len(kinds)
        for _ in range(options.repeat):
            for k, (_, program, ranks, piece_tets) in enumerate(kinds):
                with tempfile.TemporaryDirectory() as name:
                    reports[k] = run(program, case, ranks, piece_tets, options.settings, name)
                least[k] = tuple(map(min, least[k], seconds_of_filling(reports[k])))
        for (kind, _, ranks, _), (wall, cpu), report in zip(kinds, least, reports):
            pieces = next(s["pieces"] for s in report["stages"] if s["name"] == "volume")
            table.add(label(case), kind, ranks, pieces, f"{report['mesh']['tetrahedra']:,}", f"{wall:.2f}",
                      f"{wall / least[0][0]:.2f}", f"{cpu:.2f}", f"{cpu / least[0][1]:.2f}")
    table.save(options.page)


# ---- rate ----------------------------------------------------------------------------------------------------------

@dataclasses.dataclass
class Grid:
    origin: np.ndarray
    spacing: float
    sizes: np.ndarray


def sizes_at_vertices(mesh):
    """Distinct vertices, the mean length of edges of cells around each, and which are on the surface."""
    numbers, surface = number(mesh.points, mesh.surface)
    _, first, numbers = np.unique(numbers, return_index=True, return_inverse=True)
    points, cells = mesh.points[first], numbers[mesh.cells]
    length, count = np.zeros(len(points)), np.zeros(len(points))
    for a, b in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
        edge = np.linalg.norm(points[cells[:, a]] - points[cells[:, b]], axis=1)
        for k in (a, b):
            length += np.bincount(cells[:, k], edge, len(points))
            count += np.bincount(cells[:, k], minlength=len(points))
    on_surface = np.isin(number(mesh.points, mesh.surface)[0][first], surface)
    return points, length / count, on_surface


def nearest_values(points, values, origin, spacing, shape):
    """A regular grid of the values of the nearest points."""
    held = np.all((points > origin - 3 * spacing) & (points < origin + spacing * (np.array(shape) + 3)), axis=1)
    cloud, coordinates, grid = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkImageData()
    coordinates.SetData(numpy_to_vtk(points[held], deep=True))
    cloud.SetPoints(coordinates)
    array = numpy_to_vtk(values[held], deep=True)
    array.SetName("value")
    cloud.GetPointData().AddArray(array)
    grid.SetOrigin(*origin)
    grid.SetSpacing(spacing, spacing, spacing)
    grid.SetDimensions(*map(int, shape))
    interpolator = vtk.vtkPointInterpolator()
    interpolator.SetInputData(grid)
    interpolator.SetSourceData(cloud)
    interpolator.SetKernel(vtk.vtkVoronoiKernel())
    interpolator.Update()
    result = vtk_to_numpy(interpolator.GetOutput().GetPointData().GetArray("value"))
    return result.reshape(shape[::-1]).T.copy()  # VTK counts along x first


def size_grids(mesh):
    """The sizes of a mesh as regular grids, each around what the one before is too coarse for."""
    points, sizes, on_surface = sizes_at_vertices(mesh)
    grids, held = [], np.ones(len(points), bool)
    while held.any():
        low, high = points[held].min(axis=0), points[held].max(axis=0)
        spacing = (high - low).max() / 200
        if grids:
            spacing = min(spacing, grids[-1].spacing / 2)
        shape = np.ceil((high - low) / spacing).astype(int) + 3
        if np.prod(shape) > 3e7:
            break
        if grids:  # what the finer grid knows better
            outer = grids[-1]
            inner = [np.arange(n) * outer.spacing + o for n, o in zip(outer.sizes.shape, outer.origin)]
            inner = [(x > a + outer.spacing) & (x < b - outer.spacing) for x, a, b in zip(inner, low, high)]
            outer.sizes[np.ix_(*inner)] = 1e22
        grids.append(Grid(low - spacing, spacing, nearest_values(points, sizes, low - spacing, spacing, shape)))
        if spacing < 1.5 * np.median(sizes[on_surface]):
            break
        held = sizes < 2 * spacing
    return grids


def own_sizes(largest, factor):
    return f"Mesh.MeshSizeMax = {largest};\nMesh.MeshSizeExtendFromBoundary = 1;\nMesh.MeshSizeFactor = {factor};\n"


def given_sizes(folder, grids, factor, lookups=1):
    """Options for sizes from the grids; looking them up several times changes the time, not the mesh."""
    text, fields = "Mesh.MeshSizeExtendFromBoundary = 0;\nMesh.MeshSizeFromPoints = 0;\n", []
    for k, grid in enumerate(grids):
        with open(folder / f"grid{k}", "wb") as out:
            np.concatenate((grid.origin, np.full(3, grid.spacing))).astype(np.float64).tofile(out)
            np.array(grid.sizes.shape, np.int32).tofile(out)
            (grid.sizes * factor).astype(np.float64).tofile(out)
        for _ in range(lookups):
            fields.append(str(len(fields) + 1))
            text += (f"Field[{fields[-1]}] = Structured;\nField[{fields[-1]}].FileName = \"grid{k}\";\n"
                     f"Field[{fields[-1]}].TextFormat = 0;\nField[{fields[-1]}].SetOutsideValue = 1;\n"
                     f"Field[{fields[-1]}].OutsideValue = 1e22;\n")
    last = len(fields) + 1
    return (text + f"Field[{last}] = Min;\nField[{last}].FieldsList = {{{', '.join(fields)}}};\n"
            f"Background Field = {last};\n")


def hxt(folder, sizes):
    """Tetrahedra, wall and CPU seconds of the 3-D stage."""
    (folder / "fill.geo").write_text(
        'Merge "surface.msh";\nSurface Loop(1) = Surface{:};\nVolume(1) = {1};\nPhysical Volume(1) = {1};\n' + sizes)
    done = subprocess.run(["gmsh", "fill.geo", "-3", "-algo", "hxt", "-nt", "1", "-format", "msh22", "-bin", "-o",
                           "filled.msh"], capture_output=True, text=True, cwd=folder)
    times = re.search(r"Done meshing 3D \(Wall ([\d.e+-]+)s, CPU ([\d.e+-]+)s\)", done.stdout)
    if done.returncode != 0 or not times:
        sys.exit(f"gmsh ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    elements = int(re.findall(r"Info +: \d+ nodes (\d+) elements", done.stdout)[-1])
    triangles = int(re.findall(r"Info +: (\d+) elements", done.stdout)[0])
    return elements - triangles, float(times.group(1)), float(times.group(2))


def tune(wanted, factor, fill):
    """The factor that leads to the number of tetrahedra closest to the one wanted, and that number."""
    tried = []
    while len(tried) < 5 and (not tried or min(tried)[0] > 0.1):
        count = fill(factor)
        tried.append((abs(count / wanted - 1), factor, count))
        factor *= (count / wanted) ** 0.35
    return min(tried)[1:]


def matched_sizes(folder, mesh, largest):
    """Options for as many tetrahedra as ours: sizes extended from the surface where they suffice, ours where these
    are too small, as around an aircraft (no factor makes them larger). What they are, the options, and the same with
    every look-up done twice."""
    wanted = len(mesh.cells)
    if hxt(folder, own_sizes(largest, 1))[0] < 1.1 * wanted:
        factor, count = tune(wanted, 0.8, lambda f: hxt(folder, own_sizes(largest, f))[0])
        if abs(count / wanted - 1) < 0.2:
            return "extended from the surface", own_sizes(largest, factor), None
    grids = size_grids(mesh)
    factor, _ = tune(wanted, 0.72, lambda f: hxt(folder, given_sizes(folder, grids, f))[0])
    return "ours", given_sizes(folder, grids, factor), given_sizes(folder, grids, factor, 2)


def rate(options):
    table = PrintedTable("Beside Gmsh", ("case", "mesher", "sizes", "tetrahedra", "wall s", "of it look-up of sizes", "CPU s",
                                         "million tetrahedra / s", "without look-up"))
    for case in options.cases:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            def fill(output):
                return run(options.program, case, 1, 250000, options.settings, folder / output)

            report = fill("ours")
            write_msh(folder / "ours" / "surface.pvtp", folder / "surface.msh")
            largest = re.search(r"sizing:.*?\n  maximum: ([\d.e+-]+)", report["configuration"], re.DOTALL)
            largest = float(largest.group(1)) if largest else 1e22
            way, once, twice = matched_sizes(folder, read_mesh(folder / "ours"), largest)
            ours, theirs, doubled = [seconds_of_filling(report)], [], []
            for repeat in range(options.repeat):
                if repeat:
                    ours.append(seconds_of_filling(fill("again")))
                theirs.append(hxt(folder, once))
                if twice:
                    doubled.append(hxt(folder, twice))
        count, (wall, cpu) = report["mesh"]["tetrahedra"], map(min, zip(*ours))
        table.add(label(case), "Aeroloom", "–", f"{count:,}", f"{wall:.2f}", "–", f"{cpu:.2f}", f"{count / wall / 1e6:.3f}", "–")
        count, wall, cpu = map(min, zip(*theirs))
        lookup = max(0.0, min(d[2] for d in doubled) - cpu) if doubled else 0.0
        table.add(label(case), "Gmsh HXT", way, f"{count:,}", f"{wall:.2f}", f"{lookup:.2f}", f"{cpu:.2f}",
                  f"{count / wall / 1e6:.3f}", f"{count / (wall - lookup) / 1e6:.3f}")
    table.save(options.page)


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    modes = {"same": same, "cost": cost, "rate": rate}
    parser = argparse.ArgumentParser(usage=__doc__.replace("%", "%%"))
    parser.add_argument("mode", choices=modes)
    parser.add_argument("program")
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--pieces", type=int, nargs="+", default=[60000, 250000, ONE_PIECE])
    parser.add_argument("--ranks", type=int, nargs="+", default=[])
    parser.add_argument("--base")
    parser.add_argument("--repeat", type=int, default=3)
    add_page_option(parser)
    options = parser.parse_args(arguments, argparse.Namespace(settings=settings))
    modes[options.mode](options)


if __name__ == "__main__":
    main()
