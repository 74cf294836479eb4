#!/usr/bin/env python3
"""aeroloom improve FILE, the quality gate and pinned elements, as a user meets them. usage: improve_file_test.py PROGRAM"""
import json
import subprocess
import sys

import vtk
from program import COARSE_TRANSPORT, NO_PICTURES, SOURCE, Run


def improve(program, file, folder, ranks=1, settings=()):
    command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, "improve", file, "--set",
               f"output.directory={folder}", "--set", "output.pictures=false"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=120)
    report = folder / "report.json"
    return done.returncode, done.stdout + done.stderr, json.loads(report.read_text()) if report.exists() else None


def read(file):
    reader = vtk.vtkXMLPUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def write(grid, file):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(grid)
    writer.Write()


def as_another_program_writes_it(grid):
    """One grid with shared points, its boundary triangles among the cells, every other tetrahedron turned over."""
    names = grid.GetPointData().GetArray("global_id")
    name = [int(names.GetValue(i)) for i in range(grid.GetNumberOfPoints())]
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetNumberOfPoints(max(name) + 1)
    for i, number in enumerate(name):
        points.SetPoint(number, grid.GetPoint(i))
    result = vtk.vtkUnstructuredGrid()
    result.SetPoints(points)
    ids, sides = vtk.vtkIdList(), {}
    for c in range(grid.GetNumberOfCells()):
        grid.GetCellPoints(c, ids)
        corners = [name[ids.GetId(k)] for k in range(4)]
        if c % 2:
            corners[2], corners[3] = corners[3], corners[2]
        result.InsertNextCell(vtk.VTK_TETRA, 4, corners)
        for k in range(4):
            side = tuple(sorted(corners[:k] + corners[k + 1:]))
            sides[side] = sides.get(side, 0) + 1
    for side, tetrahedra in sides.items():
        if tetrahedra == 1:
            result.InsertNextCell(vtk.VTK_TRIANGLE, 3, side)
    return result


def main():
    program = sys.argv[1]
    raw = Run(program, COARSE_TRANSPORT + NO_PICTURES, 1, ("improve.enabled=false", "output.parts=2"))
    assert raw.code == 0, raw.text
    before = raw.report["quality"]["min_dihedral_deg"]
    assert all(needle["forced"] for needle in raw.report["surface"]["needles"]), raw.report["surface"]["needles"]

    # An imported file: the same result on any number of ranks, better, its space and its boundary kept.
    imported = raw.folder / "imported.vtu"
    write(as_another_program_writes_it(read(raw.output / "mesh.pvtu")), imported)
    hashes = set()
    for ranks in (1, 3):
        code, text, report = improve(program, imported, raw.folder / f"improved_{ranks}", ranks,
                                     ("volume.piece_tets=20000", "improve.target_angle=20"))
        assert code == 0, text
        hashes.add(report["mesh"]["hash"])
        assert report["improve"]["bad_after"] < 0.02 * report["improve"]["bad_before"], report["improve"]
        assert report["quality"]["min_dihedral_deg"] > max(before, 8), report["quality"]["min_dihedral_deg"]
        assert report["quality"]["mean_mean_ratio"] > raw.report["quality"]["mean_mean_ratio"]
        assert report["mesh"]["boundary_triangles"] == raw.report["mesh"]["boundary_triangles"]
        assert abs(report["mesh"]["volume"] / raw.report["mesh"]["volume"] - 1) < 1e-10
        kinds = report["improve"]["below_target"]
        assert kinds["pinned"]["tetrahedra"] == report["improve"]["pinned_tetrahedra"], kinds
        assert kinds["unresolved_features"]["tetrahedra"] == sum(f["tetrahedra"] for f in report["unresolved_features"])
        assert sum(kinds[k]["tetrahedra"] for k in ("unresolved_features", "held_by_surface", "beside", "rest")) == \
            report["improve"]["unpinned_below_target"], kinds
        assert (kinds["rest"]["smallest_dihedral_deg"] is None) == (kinds["rest"]["tetrahedra"] == 0), kinds
        assert [s["name"] for s in report["stages"]] == ["start", "input", "improve", "inspect", "output"], \
            report["stages"]
    assert len(hashes) == 1, f"the mesh depends on the number of ranks: {hashes}"

    # More than the surface of a file admits, which stays as it is.
    code, text, report = improve(program, imported, raw.folder / "held", 1, ("improve.target_angle=40", "improve.sweeps=2"))
    kinds = report["improve"]["below_target"]
    assert code == 0 and kinds["held_by_surface"]["tetrahedra"] > 0, (text, kinds)

    # Our own files, whose parts repeat the points between them.
    code, text, report = improve(program, raw.output / "mesh.pvtu", raw.folder / "own")
    assert code == 0 and report["mesh"]["boundary_triangles"] == raw.report["mesh"]["boundary_triangles"], text
    for was, now in zip(raw.report["patches"], report["patches"], strict=True):
        assert all(was[key] == now[key] for key in ("name", "type", "triangles", "inner")), now
        assert abs(now["area"] / was["area"] - 1) < 1e-12, now

    # The gate: the mesh is written, the exit code says that it is not what was asked for.
    code, text, report = improve(program, imported, raw.folder / "gate", 2,
                                 ("improve.gate.min_mean_ratio=0.99", "improve.gate.largest_angle=179",
                                  "improve.gate.largest_volume_ratio=1.5", "improve.gate.min_scaled_jacobian=1",
                                  "improve.gate.largest_non_orthogonality=1", "improve.gate.largest_skewness=1e3"))
    assert code == 6 and "min_mean_ratio" in text and "largest_angle" not in text, text
    assert "largest_volume_ratio" in text and "min_scaled_jacobian" not in text, text
    assert "largest_non_orthogonality is" in text and "a face of cell" in text and "largest_skewness" not in text, text
    solver = report["quality"]["solver"]
    assert solver["faces"]["off_layers"]["faces"] == solver["inner_faces"] > 0 == solver["faces"]["at_front"]["faces"], solver
    cells = report["quality"]["cells"]["tetrahedra"]
    assert cells["volume_ratio"]["maximum"] > 1.5 and cells["mean_ratio"]["cells"] == report["mesh"]["tetrahedra"]
    assert abs(cells["mean_ratio"]["mean"] - report["quality"]["mean_mean_ratio"]) < 1e-12
    assert report["exit_code"] == 6 and (raw.folder / "gate" / "mesh.pvtu").exists()


if __name__ == "__main__":
    main()
