#!/usr/bin/python3
"""Angles of the finished mesh, side by side with Gmsh, as a Markdown table.

usage: improvement.py PROGRAM CASE ... [--page FILE] [-- KEY=VALUE ...]

Each case runs on one rank. Gmsh gets the same surface mesh and fills it with its HXT algorithm and with its default
(-algo del3d -optimize_netgen stays off: what `gmsh -3` does), sizes extended from the surface and scaled until the
number of tetrahedra is within 10 % of ours. CPU s: ours of the stages volume and improve (decompose apart), theirs of
the 3-D stage, all on one thread. Per million: tetrahedra with an angle below or above so many degrees. The figures of
all meshes come from the same place, `aeroloom improve` without improvement. Needs gmsh and the system's python3-vtk9.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import vtk

from printed_table import PrintedTable, take_page_option

ROOT = pathlib.Path(__file__).resolve().parent.parent


def ours(program, case, settings, folder):
    command = [program, "run", case, "--set", f"output.directory={folder}"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    if done.returncode not in (0, 6):
        sys.exit(f"{case} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads((folder / "report.json").read_text())


def write_msh(surface, file):
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(str(surface))
    reader.Update()
    mesh = reader.GetOutput()
    names, faces = mesh.GetPointData().GetArray("global_id"), mesh.GetCellData().GetArray("face")
    points = {int(names.GetValue(i)): mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())}
    ids = vtk.vtkIdList()
    with open(file, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        for number, p in points.items():
            out.write(f"{number + 1} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g}\n")
        out.write(f"$EndNodes\n$Elements\n{mesh.GetNumberOfCells()}\n")
        for c in range(mesh.GetNumberOfCells()):
            mesh.GetCellPoints(c, ids)
            corners = " ".join(str(int(names.GetValue(ids.GetId(k))) + 1) for k in range(3))
            out.write(f"{c + 1} 2 2 0 {int(faces.GetValue(c)) + 1} {corners}\n")
        out.write("$EndElements\n")


def gmsh(folder, algorithm, largest, factor):
    """CPU seconds of the 3-D stage, and the mesh as .vtk."""
    (folder / "fill.geo").write_text(
        'Merge "surface.msh";\nSurface Loop(1) = Surface{:};\nVolume(1) = {1};\n'
        f"Mesh.MeshSizeMax = {largest};\nMesh.MeshSizeExtendFromBoundary = 1;\nMesh.MeshSizeFactor = {factor};\n")
    result = folder / f"{algorithm}.vtk"
    done = subprocess.run(["gmsh", "fill.geo", "-3", "-algo", algorithm, "-nt", "1", "-format", "vtk", "-bin", "-o",
                           result], capture_output=True, text=True, cwd=folder)
    cpu = sum(float(seconds) for stage, seconds in
              re.findall(r"Done (meshing 3D|optimizing mesh) \(Wall [\d.e+-]+s, CPU ([\d.e+-]+)s\)", done.stdout))
    return cpu, result


def judge(program, file, folder):
    command = [program, "improve", file, "--set", "improve.enabled=false", "--set", f"output.directory={folder}",
               "--set", "volume.piece_tets=100000000"]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    report = folder / "report.json"
    if done.returncode != 0 or not report.exists():
        return None
    return json.loads(report.read_text())


def add_row(table, name, report, cpu):
    if report is None:
        table.add(name, "failed")
        return
    quality, count = report["quality"], report["mesh"]["tetrahedra"]
    smallest = quality["min_dihedral"]["histogram"]["counts"]
    largest = quality["max_dihedral"]["histogram"]["counts"]  # bins of two degrees
    per_million = [1e6 * n / count for n in (sum(smallest[:5]), sum(smallest[:10]), sum(largest[80:]))]
    table.add(name, f"{count:,}", f"{quality['min_dihedral_deg']:.1f}", f"{quality['max_dihedral_deg']:.1f}",
              *(f"{n:.1f}" for n in per_million), f"{quality['min_dihedral']['percentile_0.1']:.1f}",
              f"{quality['min_mean_ratio']:.2f}", f"{quality['mean_mean_ratio']:.3f}", f"{cpu:.2f}", f"{count / cpu / 1e6:.2f}")


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    arguments, page = take_page_option(arguments)
    program = os.path.abspath(arguments[0])
    table = PrintedTable("Beside Gmsh", ("mesh", "tetrahedra", "smallest", "largest", "< 10 /M", "< 20 /M", "> 160 /M", "0.1 %",
                                         "mean ratio, least", "average", "CPU s", "Mtets/s"))
    for case in arguments[1:]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            report = ours(program, os.path.abspath(case), settings, folder / "ours")
            stages = {s["name"]: s["cpu_seconds_mean"] * report["ranks"] for s in report["stages"]}
            label = pathlib.Path(case).stem.removeprefix("improve_")
            add_row(table, f"{label}: Aeroloom", report, stages["volume"] + stages["improve"])
            write_msh(folder / "ours" / "surface.pvtp", folder / "surface.msh")
            largest = re.search(r"maximum: ([\d.e+-]+)", report["configuration"][report["configuration"].index("sizing"):])
            largest = float(largest.group(1)) if largest else 1e22
            for algorithm, title in (("hxt", "Gmsh HXT"), ("del3d", "Gmsh default")):
                factor = 1.0
                for _ in range(4):
                    cpu, mesh = gmsh(folder, algorithm, largest, factor)
                    theirs = judge(program, mesh, folder / "judged")
                    if theirs is None or abs(theirs["mesh"]["tetrahedra"] / report["mesh"]["tetrahedra"] - 1) < 0.1:
                        break
                    factor *= (theirs["mesh"]["tetrahedra"] / report["mesh"]["tetrahedra"]) ** (1 / 3)
                add_row(table, f"{label}: {title}", theirs, cpu)
    table.save(page)


if __name__ == "__main__":
    main()
