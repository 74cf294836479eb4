#!/usr/bin/env python3
"""The same CAD at the same sizes by Aeroloom and by the usual meshers, as Markdown tables; losses stand beside wins.

usage: peers.py PROGRAM CASE ... [--arbiter CHECKER] [--ranks N] [--limit SECONDS] [--tries N] [--only PEER ...] [--page FILE]

For each case: Aeroloom; Gmsh with its default algorithm and with HXT on one thread, and Netgen, on the domain that our program
exports as STEP, with our bounds of sizes and curvature, scaled until the numbers of tetrahedra are within a sixth of each other
(in --tries 4, else the nearest); TetGen on our surface, with the lengths of its edges as sizes. snappyHexMesh makes hexahedra
and fits nothing of this; Mmg is not in Debian 12. A peer that is not installed, fails, or takes longer than LIMIT (120 s) is
listed as that. Seconds are wall seconds of the processes, with reading and writing; memory is the largest resident set, of
Aeroloom that of all ranks. Angles and ratios are those of `aeroloom quality`; an arbiter (a program that prints what
`meshcheck` prints) says whether meshes are valid. The second table is what solvers say: OpenFOAM's checkMesh, and
Code_Saturne's cs_solver --quality (share of cells it calls bad by its criteria of orthogonality, offset, least-squares
gradient, volume ratio).

Needs what it compares with, and python3-vtk9: gmsh, python3-netgen, tetgen, openfoam, code-saturne.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

from printed_table import PrintedTable, add_page_option

ROOT = pathlib.Path(__file__).resolve().parent.parent
NEAR = (0.86, 1.17)
CURVATURE = "Mesh.MeshSizeFromCurvature"


class Failed(Exception):
    pass


def call(command, folder, limit, name="log", where=None):
    """Wall seconds and the largest resident set in bytes; what it printed is in a file."""
    start = time.monotonic()
    with open(folder / name, "w") as log:
        process = subprocess.Popen([str(word) for word in command], cwd=where or folder, stdout=log, stderr=subprocess.STDOUT)
        pid, status, usage = 0, 0, None
        while pid == 0:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid == 0 and time.monotonic() - start > limit:
                process.kill()
                os.wait4(process.pid, 0)
                process.returncode = -9
                raise Failed(f"not within {limit} s")
            time.sleep(0.01)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        said = (folder / name).read_text(errors="replace").strip().splitlines()
        why = [line for line in said if "rror" in line and "Stopped" not in line] or said or [""]
        raise Failed(f"ended with {process.returncode}: {why[0][:100].replace('|', ' ')}")
    return time.monotonic() - start, 1024 * usage.ru_maxrss


def quality(options, file, folder):
    """Of any file that is read: counts, angles, ratios; by the arbiter where there is one."""
    told = folder / "quality.json"
    done = subprocess.run([options.program, "quality", file, "--output", told], capture_output=True, text=True, check=False)
    if not told.exists():
        raise Failed("the mesh cannot be judged: " + (done.stderr.strip().splitlines() or ["no word"])[-1][:100])
    return json.loads(told.read_text())


def measures(report):
    cells = report["cells"]["tetrahedra"] if "cells" in report else report["quality"]["tetrahedra"]
    angle, ratio = cells["min_dihedral_deg"], cells["mean_ratio"]
    return {"tetrahedra": angle["cells"], "least": angle["minimum"], "largest": cells["max_dihedral_deg"]["maximum"],
            "p01": angle["percentile_0.1"], "p1": angle["percentile_1"], "ratio": ratio["mean"], "least ratio": ratio["minimum"]}


def ours(options, case, folder):
    command = [ROOT / "scripts/mpirun_local.sh", options.ranks, options.program, "run", os.path.abspath(case)]
    for setting in (f"output.directory={folder}", "output.pictures=false", "output.formats=[vtu,msh]", "output.parts=1"):
        command += ["--set", setting]
    wall, _ = call(command, folder, 10 * options.limit, where=ROOT)
    report = json.loads((folder / "report.json").read_text())
    memory = max(stage["peak_rss_bytes_sum"] for stage in report["stages"])
    stages = ", ".join(f"{s['name']} {s['wall_seconds']:.1f}" for s in report["stages"])
    return {"wall": wall, "memory": memory, "stages": stages, "file": folder / "mesh.msh", "report": report}


def gmsh(algorithm):
    def mesh(options, folder, sizes, factor):
        if not shutil.which("gmsh"):
            raise Failed("not installed")
        (folder / "domain.geo").write_text(
            'SetFactory("OpenCASCADE");\nMerge "domain.step";\n'
            f"{CURVATURE} = {360 / sizes['curvature_angle']:.6g};\nMesh.MeshSizeMin = {sizes['minimum']:.9g};\n"
            f"Mesh.MeshSizeMax = {sizes['maximum']:.9g};\nMesh.MeshSizeFactor = {factor:.9g};\n")
        wall, memory = call(["gmsh", "domain.geo", "-3", *algorithm, "-nt", "1", "-format", "msh41", "-bin", "-o", "theirs.msh"],
                            folder, options.limit)
        said = (folder / "log").read_text(errors="replace")
        steps = [line.split("Wall ")[1].split("s")[0] for line in said.splitlines() if "Done meshing" in line and "Wall " in line]
        return {"wall": wall, "memory": memory, "file": folder / "theirs.msh",
                "stages": ", ".join(f"{k + 1}-D {float(t):.1f}" for k, t in enumerate(steps))}
    return mesh


NETGEN = """
import json, sys
from netgen.NgOCC import LoadOCCGeometry, GenerateMesh
from netgen.meshing import MeshingParameters
sizes = json.loads(sys.argv[1])
mesh = GenerateMesh(LoadOCCGeometry("domain.step"), MeshingParameters(
    maxh=sizes["maximum"], grading=0.3, curvaturesafety=sizes["safety"]))
mesh.Export("theirs.msh2", "Gmsh2 Format")
"""


def netgen(options, folder, sizes, factor):
    if subprocess.run(["/usr/bin/python3", "-c", "import netgen.NgOCC"], capture_output=True, check=False).returncode != 0:
        raise Failed("not installed")
    asked = {"maximum": factor * sizes["maximum"], "safety": 57.3 / sizes["curvature_angle"] / factor}
    (folder / "netgen_run.py").write_text(NETGEN)
    wall, memory = call(["/usr/bin/python3", "netgen_run.py", json.dumps(asked)], folder, options.limit)
    call(["gmsh", "theirs.msh2", "-save", "-format", "msh41", "-bin", "-o", "theirs.msh"], folder, options.limit, "log_convert")
    return {"wall": wall, "memory": memory, "file": folder / "theirs.msh", "stages": "–"}


def surface_for_tetgen(folder, ours_folder):
    """surface.smesh and surface.mtr: our boundary, a hole in each body, the mean edge at each point as its size."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    import numpy
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(str(ours_folder / "surface.pvtp"))
    clean = vtk.vtkCleanPolyData()
    clean.PointMergingOn()
    clean.SetTolerance(0)
    clean.SetInputConnection(reader.GetOutputPort())
    connected = vtk.vtkPolyDataConnectivityFilter()
    connected.SetExtractionModeToAllRegions()
    connected.ColorRegionsOn()
    connected.SetInputConnection(clean.GetOutputPort())
    connected.Update()
    mesh = connected.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    part = vtk_to_numpy(mesh.GetPointData().GetArray("RegionId"))[triangles[:, 0]]
    edges = numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    lengths = numpy.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    total, count = numpy.zeros(len(points)), numpy.zeros(len(points))
    for column in (0, 1):
        numpy.add.at(total, edges[:, column], lengths)
        numpy.add.at(count, edges[:, column], 1)
    corners = points[triangles]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = numpy.linalg.norm(normals, axis=1)
    extents = {p: numpy.ptp(corners[part == p].reshape(-1, 3), axis=0).max() for p in set(part)}
    outer = max(extents, key=extents.get)
    holes = []
    for p in extents:
        if p == outer:
            continue
        # Triangles point out of the fluid: from the middle of a large one a little way on is inside the body.
        middle = numpy.flatnonzero(part == p)[numpy.argmax(areas[part == p])]
        holes.append(corners[middle].mean(axis=0) + 0.05 * numpy.sqrt(areas[middle]) * normals[middle] / areas[middle])
    with open(folder / "surface.smesh", "w") as file:
        file.write(f"{len(points)} 3 0 0\n" + "".join(f"{i} {p[0]!r} {p[1]!r} {p[2]!r}\n" for i, p in enumerate(points.tolist())))
        file.write(f"{len(triangles)} 0\n" + "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles.tolist()))
        file.write(f"{len(holes)}\n" + "".join(f"{i} {h[0]!r} {h[1]!r} {h[2]!r}\n" for i, h in enumerate(holes)))
    sizes = total / numpy.maximum(count, 1)
    (folder / "surface.mtr").write_text(f"{len(points)} 1\n" + "".join(f"{size!r}\n" for size in sizes.tolist()))


def tetgen(options, folder, ours_folder):
    if not shutil.which("tetgen"):
        raise Failed("not installed")
    surface_for_tetgen(folder, ours_folder)
    wall, memory = call(["tetgen", "-pYmq1.4/10kNEF", "surface.smesh"], folder, options.limit)
    return {"wall": wall, "memory": memory, "file": folder / "surface.1.vtk", "stages": "volume alone"}


def in_millimetres(report):
    """Readers of STEP scale models to millimetres; a file without a unit is written as it is."""
    unit = report["geometry"]["unit_in_metres"]
    scale = 1000 * unit if report["geometry"]["unit"] else 1
    return {"minimum": scale * report["sizing"]["minimum"], "maximum": scale * report["sizing"]["maximum"],
            "curvature_angle": report["sizing"]["curvature_angle"]}


def arbitrate(options, file, folder):
    """The arbiter's verdict on a mesh, in a word."""
    if not options.arbiter:
        return "–"
    call([options.program, "convert", file, folder / "judged.pvtu", "--parts", "1"], folder, options.limit, "log_convert")
    said = subprocess.run([options.arbiter, folder / "judged.pvtu"], capture_output=True, text=True, check=False).stdout
    return "valid" if re.search(r"^VALID yes", said, re.MULTILINE) else "not valid"


def solvers(options, file, folder):
    """Lines of what OpenFOAM and Code_Saturne say of a mesh."""
    told = []
    environment = os.environ | {"WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}
    try:
        place = folder / "openfoam"
        call([options.program, "convert", file, place / "mesh.foam", "--format", "openfoam", "--parts", "1"], folder,
             options.limit, "log_convert")
        said = subprocess.run(["checkMesh", "-case", place], capture_output=True, text=True, check=False,
                              env=environment | {"PWD": str(folder)}, cwd=folder).stdout
        found = re.search(r"non-orthogonality Max: ([\d.]+) average: ([\d.]+)", said)
        skew = re.search(r"Max skewness = ([\d.]+)", said)
        if found:
            told += [f"{float(found[1]):.1f}", f"{float(found[2]):.1f}", f"{float(skew[1]):.2f}"]
            told += ["OK" if "Mesh OK" in said else "fails"]
        else:
            told += ["no answer"] * 4
    except (Failed, FileNotFoundError) as why:
        told += [str(why)[:40]] + ["–"] * 3
    try:
        call([options.program, "convert", file, folder / "theirs.cgns"], folder, options.limit, "log_convert")
        call(["/usr/lib/code_saturne/cs_preprocess", "--out", "mesh_input", "theirs.cgns"], folder, options.limit,
             "log_preprocess")
        call(["/usr/lib/code_saturne/cs_solver", "--quality"], folder, options.limit, "log_quality")
        said = (folder / "run_solver.log").read_text(errors="replace")
        bad = [int(n) for n in re.findall(r"Number of bad cells detected: (\d+)", said)[:4]]
        cells = int(re.search(r"Number of cells:? *(\d+)", said)[1])
        told += [f"{100 * count / cells:.2f}" for count in bad]
    except (Failed, FileNotFoundError, TypeError) as why:
        told += [str(why)[:40]] + ["–"] * 3
    shutil.rmtree(folder / "postprocessing", ignore_errors=True)
    return told


def matched(mesh, options, folder, sizes, wanted):
    """The mesh whose count is nearest to ours, and its measures."""
    factor, best = 1.0, None
    for _ in range(options.tries):
        found = mesh(options, folder, sizes, factor)
        judged = measures(quality(options, found["file"], folder))
        error = judged["tetrahedra"] / wanted
        if best is None or abs(error - 1) < best[0]:
            best = (abs(error - 1), found, judged)
        if NEAR[0] < error < NEAR[1]:
            break
        factor *= min(max(error, 0.1), 10) ** 0.4
    return best[1], best[2]


def row(case, peer, ranks, found, judged):
    rate = judged["tetrahedra"] / found["wall"] / ranks
    memory = found["memory"] / 2**20
    return (case, peer, f"{judged['tetrahedra']:,}", f"{found['wall']:.1f}", f"{rate:,.0f}", f"{memory:,.0f}",
            f"{judged['least']:.2f}", f"{judged['p01']:.1f}", f"{judged['p1']:.1f}", f"{judged['largest']:.1f}",
            f"{judged['ratio']:.3f}", found["verdict"], found["stages"])


def compare(options, case, table):
    """Adds the rows of the first table as they come, and returns those of the second."""
    label, said = pathlib.Path(case).stem.removeprefix("peers_"), []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mine = folder / "ours"
        mine.mkdir()
        found = ours(options, case, mine)
        judged = measures(quality(options, found["file"], mine))
        found["verdict"] = arbitrate(options, found["file"], mine)
        table.add(*row(label, "Aeroloom", options.ranks, found, judged))
        said.append((label, "Aeroloom", *solvers(options, found["file"], mine)))
        call([options.program, "export-cad", os.path.abspath(case), folder / "domain.step", "--domain"], folder,
             options.limit, where=ROOT)
        sizes = in_millimetres(found["report"])
        peers = {"Gmsh": gmsh([]), "Gmsh HXT": gmsh(["-algo", "hxt"]), "Netgen": netgen}
        for peer in [*peers, "TetGen", "Mmg"]:
            if options.only and peer not in options.only:
                continue
            place = folder / peer.replace(" ", "_")
            place.mkdir()
            shutil.copy(folder / "domain.step", place)
            try:
                if peer == "Mmg":
                    raise Failed("found, but no way to run it is known here" if shutil.which("mmg3d") else "not installed")
                if peer == "TetGen":
                    theirs = tetgen(options, place, mine)
                    their_measures = measures(quality(options, theirs["file"], place))
                else:
                    theirs, their_measures = matched(peers[peer], options, place, sizes, judged["tetrahedra"])
                theirs["verdict"] = arbitrate(options, theirs["file"], place)
                table.add(*row(label, peer, 1, theirs, their_measures))
                said.append((label, peer, *solvers(options, theirs["file"], place)))
            except Failed as why:
                table.add(label, peer, why)
    return said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--only", nargs="+")
    parser.add_argument("--arbiter", type=os.path.abspath)
    parser.add_argument("--tries", type=int, default=4)
    add_page_option(parser)
    options = parser.parse_args()
    table = PrintedTable("Meshes and times", ("case", "mesher", "tetrahedra", "wall s", "per second and core", "MiB", "least angle",
                                              "0.1 %", "1 %", "largest", "mean ratio", "arbiter", "seconds by stage"))
    said = [row for case in options.cases for row in compare(options, case, table)]
    table.save(options.page)
    print()
    table = PrintedTable("What solvers say", ("case", "mesher", "non-orthogonality, largest", "mean", "skewness", "checkMesh",
                                              "orthogonality, bad %", "offset", "gradient", "volume ratio"))
    for row_of_solvers in said:
        table.add(*row_of_solvers)
    table.save(options.page)


if __name__ == "__main__":
    main()
