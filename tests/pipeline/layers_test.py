#!/usr/bin/env python3
"""Boundary layers from the case to the files: prisms on walls, the same mesh on any number of ranks and after a resumed run, the
surface as it is without layers, rows of the report. usage: layers_test.py PROGRAM"""
import collections
import json
import subprocess
import sys

import jsonschema
import numpy
import vtk
from vtkmodules.util.numpy_support import vtk_to_numpy

from program import NO_PICTURES, SOURCE, Run

sys.path.append(str(SOURCE / "benchmarks"))
import layer_coverage  # noqa: E402

SPHERE = f"""
geometry: {{file: "{SOURCE}/configs/geometry/sphere.brep"}}
farfield: {{shape: box, extent: 2}}
sizing:
  {{minimum: 0.05, maximum: 2, curvature_angle: 20, growth: 1.8, proximity: 0, sources: {{near: {{shape: point, center: [1, 0, 0], size: 0.05}}}}}}
surface: {{piece_triangles: 100}}
volume: {{piece_tets: 800}}
""" + NO_PICTURES
LAYERS = "layers: {first: 1e-3, growth: 1.5}\n"
DUCT = f"""
geometry: {{file: "{SOURCE}/configs/geometry/duct.step", domain: fluid}}
patches: {{inlet: {{faces: ['#ff0000'], type: inlet}}, outlet: {{type: outlet}}}}
sizing: {{target_tetrahedra: 2000}}
layers: {{first: 1e-3}}
""" + NO_PICTURES
SCHEMA = json.loads((SOURCE / "docs" / "report.schema.json").read_text())


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def check_files(run, bare):
    """Cells and layers as the report counts them; the surface is that of a run without layers."""
    grid = read(vtk.vtkXMLPUnstructuredGridReader(), run.output / "mesh.pvtu")
    layer = vtk_to_numpy(grid.GetCellData().GetArray("layer"))
    types = collections.Counter(grid.GetCellType(c) for c in range(grid.GetNumberOfCells()))
    mesh, row = run.report["mesh"], run.report["layers"]["patches"][0]
    assert types[vtk.VTK_WEDGE] == mesh["prisms"] == row["prisms"] > 1000, (types, mesh, row)
    assert types[vtk.VTK_PYRAMID] == mesh["pyramids"] == row["pyramids"], (types, mesh, row)
    assert types[vtk.VTK_TETRA] == mesh["tetrahedra"], (types, mesh)
    assert mesh["layer_tetrahedra"] == row["tetrahedra"] > 0
    page = (run.output / "report.html").read_text()
    assert "off the boundary layers" in page and "without boundary layers" not in page
    quality = run.report["quality"]
    assert [flaw["flaw"] for flaw in quality["flaws"]] == \
        ["smallest_angle", "shape", "size_jump", "non_orthogonality", "skewness"], quality["flaws"]
    assert len(quality["places"]) == 10 and "Cells of layers: shape" in page and "The worst places, of all cells" in page
    assert "As cell-centred solvers judge" in page and "within layers" in page
    faces, solver = quality["solver"]["faces"], quality["solver"]
    assert all(faces[name]["faces"] > 0 for name in ("within_layers", "at_front", "off_layers")), faces
    assert sum(of["faces"] for of in faces.values()) == solver["inner_faces"], solver
    assert solver["boundary_faces"] == mesh["boundary_triangles"] + mesh["boundary_quadrilaterals"], (solver, mesh)
    assert run.text.count("quality, as solvers judge: ") == 2, run.text
    assert numpy.count_nonzero(layer) == row["prisms"] + row["pyramids"] + row["tetrahedra"]
    assert layer.max() == row["layers_max"] > 5 and layer.min() == 0
    surfaces = [read(vtk.vtkXMLPPolyDataReader(), r.output / "surface.pvtp") for r in (run, Run(*bare))]
    points = [vtk_to_numpy(s.GetPoints().GetData()) for s in surfaces]
    # Improvement moves vertices of a boundary that has no layers, if few of them.
    assert surfaces[0].GetNumberOfCells() <= mesh["boundary_triangles"] + mesh["boundary_quadrilaterals"]
    assert points[0].shape[1] == 3 and abs(len(points[0]) - len(points[1])) < 0.02 * len(points[1])


def check_report(report):
    errors = [e.message for e in jsonschema.Draft202012Validator(SCHEMA).iter_errors(report)]
    assert not errors, errors
    row, = report["layers"]["patches"]
    assert row["first"] == 1e-3 and row["growth"] == 1.5 and row["count"] is None
    assert row["full"] > 0.95 and report["layers"]["empty"] == 0, report["layers"]
    assert [s["name"] for s in report["stages"]] == ["start", "geometry", "sizing", "surface", "layers", "decompose", "volume",
                                                     "improve", "inspect", "output"]
    # The flat cells at the wall do not count.
    assert report["quality"]["min_dihedral_deg"] > 5, report["quality"]["min_dihedral_deg"]


def check_resumed(program, folder, wanted):
    run = Run(program, SPHERE + LAYERS, 1, ("output.checkpoints=resume",), folder=folder)
    assert run.code == 0 and run.report["mesh"]["hash"] == wanted, run.text
    assert run.report["resumed"] == ["geometry", "sizing", "surface", "volume", "improve"], run.report["resumed"]
    other = Run(program, SPHERE + LAYERS, 2, ("output.checkpoints=resume", "layers.growth=1.4"), folder=folder)
    assert other.code == 0 and other.report["resumed"] == ["geometry", "sizing", "surface"], other.report["resumed"]
    assert other.report["mesh"]["hash"] != wanted


def check_measured(run):
    """A program that reads the files alone finds what the report tells."""
    found, said = layer_coverage.measure(run.output)[0][1:]
    for key in ("full", "partial", "empty"):
        assert abs(found[key] - said[key]) < 1e-6, (key, found, said)
    assert abs(found["layers_mean"] - said["layers_mean"]) < 1e-6 * said["layers_mean"], (found, said)
    assert abs(found["first"][1] - 1) < 0.02 and abs(found["growth"][1] - 1.5) < 0.05, found  # the last five layers are stretched


def check_tets(program, folder, prisms):
    """Cut into tetrahedra, after a run with prisms from what that has left; a gate that is met changes nothing."""
    settings = ("output.checkpoints=resume", "layers.elements=tets")
    runs = [Run(program, SPHERE + LAYERS, ranks, settings + gate, folder=folder) for ranks, gate in ((1, ()), (3, ("layers.gate.full_area=0.9",)))]
    assert [run.code for run in runs] == [0, 0], [run.text for run in runs]
    assert runs[1].report["resumed"] == ["geometry", "sizing", "surface", "volume", "improve"], runs[1].report["resumed"]
    hashes = {run.report["mesh"]["hash"] for run in runs}
    assert len(hashes) == 1, "the mesh depends on the number of ranks"
    mesh, row = runs[1].report["mesh"], runs[1].report["layers"]["patches"][0]
    of_prisms = prisms["layers"]["patches"][0]
    assert mesh["prisms"] == mesh["pyramids"] == row["prisms"] == row["pyramids"] == 0, mesh
    assert row["tetrahedra"] == mesh["layer_tetrahedra"] == 3 * of_prisms["prisms"] + 2 * of_prisms["pyramids"] + of_prisms["tetrahedra"], row
    assert mesh["points"] == prisms["mesh"]["points"] and abs(mesh["volume"] / prisms["mesh"]["volume"] - 1) < 1e-12, mesh
    grid = read(vtk.vtkXMLPUnstructuredGridReader(), runs[1].output / "mesh.pvtu")
    assert {grid.GetCellType(c) for c in range(grid.GetNumberOfCells())} == {vtk.VTK_TETRA}
    assert numpy.count_nonzero(vtk_to_numpy(grid.GetCellData().GetArray("layer"))) == row["tetrahedra"]
    gate, = runs[1].report["quality"]["gate"]
    assert gate["key"] == "layers.gate.full_area" and gate["met"] and gate["limit"] == 0.9 and gate["value"] > 0.99, gate
    check_measured(runs[1])
    check_warning(program, runs[1].output)


def check_warning(program, folder):
    """Improvement of a file would destroy layers: it warns before it begins."""
    done = subprocess.Popen([program, "improve", folder / "mesh.pvtu", "--set", f"output.directory={folder / 'improved'}"],
                            stderr=subprocess.PIPE, text=True)
    for line in done.stderr:
        if "as those of boundary layers have" in line:
            break
    else:
        raise AssertionError("no warning")
    done.terminate()
    done.communicate(timeout=60)


def check_gate(program):
    """A missed gate ends the run with mesh and report written, and tells where layers are missing."""
    run = Run(program, DUCT, 2, ("layers.gate.full_area=1",))
    assert run.code == 6 and (run.output / "mesh.pvtu").exists(), run.text
    assert "layers.gate.full_area is 0" in run.text and "patch 'body' lacks layers on" in run.text, run.text
    gate, = run.report["quality"]["gate"]
    assert not gate["met"] and gate["value"] == run.report["layers"]["full"] and run.report["exit_code"] == 6, gate
    for row in run.report["layers"]["patches"]:
        assert 0.5 * row["layers_wanted_mean"] < row["layers_mean"] < row["layers_wanted_mean"], row


def check_plane(program):
    """Layers end on a plane of symmetry: in its quadrilaterals, exactly planar; the rest of it is meshed again."""
    half = SPHERE.replace("extent: 2", "extent: 2, symmetry: y") + LAYERS
    runs = [Run(program, half, ranks) for ranks in (1, 3)]
    assert all(run.code == 0 for run in runs), [run.text for run in runs]
    mesh = runs[0].report["mesh"]
    assert mesh["hash"] == runs[1].report["mesh"]["hash"], "the mesh depends on the number of ranks"
    assert mesh["boundary_quadrilaterals"] > 100 and runs[0].report["layers"]["full"] > 0.95, runs[0].report["layers"]
    surface = read(vtk.vtkXMLPPolyDataReader(), runs[0].output / "surface.pvtp")
    points = vtk_to_numpy(surface.GetPoints().GetData())
    ids = vtk.vtkIdList()
    quads = 0
    for cell in range(surface.GetNumberOfCells()):
        surface.GetCellPoints(cell, ids)
        if ids.GetNumberOfIds() == 4:
            quads += 1
            assert all(points[ids.GetId(k)][1] == 0 for k in range(4)), "a layer leaves the plane"
    assert quads == mesh["boundary_quadrilaterals"]
    assert surface.GetNumberOfCells() == quads + mesh["boundary_triangles"]


def check_fit(program):
    """Layers that their count ends early grow more, one growth for the patch, and end as high as triangles are wide."""
    text = SPHERE + "layers: {first: 1e-3, growth: 1.2, count: 24, total: 0.2, fit: growth}\n"
    runs = [Run(program, text, ranks) for ranks in (1, 2)]
    assert all(run.code == 0 for run in runs), [run.text for run in runs]
    assert runs[0].report["mesh"]["hash"] == runs[1].report["mesh"]["hash"], "the mesh depends on the number of ranks"
    row, = runs[0].report["layers"]["patches"]
    assert 1.2 < row["growth"] < 1.3 and row["count"] == 24 and row["total"] is None, row
    assert row["isotropic"] > 0.98 and abs(row["last_mean"] - 0.7) < 0.07 and row["layers_max"] == 24, row
    assert f"growth {row['growth']:.4g} for 1.2" in runs[0].text and "layers end at" not in runs[0].text, runs[0].text


def main():
    program = sys.argv[1]
    check_plane(program)
    check_gate(program)
    check_fit(program)
    runs = {ranks: Run(program, SPHERE + LAYERS, ranks, (f"output.checkpoints={keeps}",)) for ranks, keeps in ((1, "none"), (3, "write"))}
    for ranks, run in runs.items():
        assert run.code == 0, f"{ranks} ranks ended with {run.code}:\n{run.text}"
    hashes = {run.report["mesh"]["hash"] for run in runs.values()}
    print(hashes, {ranks: round(run.seconds, 1) for ranks, run in runs.items()})
    assert len(hashes) == 1, "the mesh depends on the number of ranks"
    check_report(runs[1].report)
    check_files(runs[3], (program, SPHERE))
    check_measured(runs[3])
    check_tets(program, runs[3].folder, runs[3].report)
    check_resumed(program, runs[3].folder, *hashes)

if __name__ == "__main__":
    main()
