#!/usr/bin/env python3
"""Potential flow about what is in a mesh, by OpenFOAM on several ranks.

usage: potential_flow.py MESH FOLDER [--ranks N] [--program AEROLOOM]
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys

SPEED = 50.0
ROOT = pathlib.Path(__file__).resolve().parents[2]

HEADER = """FoamFile
{{
    version     2.0;
    format      ascii;
    class       {kind};
    object      {name};
}}

dimensions      {dimensions};
internalField   uniform {value};
boundaryField
{{
{conditions}
    "procBoundary.*" {{ type processor; value uniform {value}; }}
}}
"""


def field(name, kind, dimensions, value, by_group):
    lines = "\n".join(f"    {group} {{ {text} }}" for group, text in by_group.items())
    return HEADER.format(name=name, kind=kind, dimensions=dimensions, value=value, conditions=lines)


# Conditions by group of patches; what is slip, inlet or outlet is as good as a wall or the far field here, where
# the potential of the free stream is given.
OUTER, INNER = ("farfield", "inlet", "outlet"), ("wall", "slip")


def conditions(outer, inner):
    return {group: outer for group in OUTER} | {group: inner for group in INNER} | {"symmetry": "type symmetry;"}


FIELDS = {
    "U": field("U", "volVectorField", "[0 1 -1 0 0 0 0]", "(0 0 0)", conditions("type zeroGradient;", "type slip;")),
    "p": field("p", "volScalarField", "[0 2 -2 0 0 0 0]", "0",
               conditions("type fixedValue; value uniform 0;", "type zeroGradient;")),
    "Phi": field("Phi", "volScalarField", "[0 2 -1 0 0 0 0]", "0",
                 conditions(f"type exprFixedValue; valueExpr \"-{SPEED}*pos().x()\"; value uniform 0;",
                            "type zeroGradient;"))}


# Tighter than what the case gets by itself: the noise of an unfinished solution must not be mistaken for the mesh's.
SOLUTION = """FoamFile { version 2.0; format ascii; class dictionary; object fvSolution; }
solvers
{
    "(p|Phi)" { solver GAMG; smoother DICGaussSeidel; tolerance 1e-12; relTol 1e-5; }
}
potentialFlow { nNonOrthogonalCorrectors 15; }
"""
SCHEMES = """FoamFile { version 2.0; format ascii; class dictionary; object fvSchemes; }
ddtSchemes { default steadyState; }
gradSchemes { default leastSquares; }
divSchemes { default Gauss linear; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""


def run(command, folder, log):
    environment = os.environ | {"PWD": str(folder), "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}
    with open(folder / log, "w", encoding="utf-8") as out:
        code = subprocess.run([str(word) for word in command], cwd=folder, env=environment, stdout=out,
                              stderr=subprocess.STDOUT, check=False).returncode
    text = (folder / log).read_text(errors="replace")
    if code != 0 or "FATAL" in text:
        sys.exit(f"{command[0]}: see {folder / log}\n" + text[-1500:])
    return text


def draw(folder, image):
    """The speed on a plane across the middle of the body, seen from the side."""
    import vtk

    reader = vtk.vtkPOpenFOAMReader()
    reader.SetController(vtk.vtkDummyController())
    reader.SetFileName(str(folder / "mesh.foam"))
    reader.SetCaseType(0)  # decomposed
    reader.SkipZeroTimeOff()
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.DisableAllCellArrays()
    reader.SetCellArrayStatus("U", 1)
    reader.CreateCellToPointOn()
    reader.Update()
    walls, cut = vtk.vtkAppendPolyData(), vtk.vtkAppendPolyData()
    plane = vtk.vtkPlane()
    plane.SetNormal(0, 1, 0)
    plane.SetOrigin(0, -0.01, 0)
    blocks = reader.GetOutput().NewIterator()
    bounds = None
    while not blocks.IsDoneWithTraversal():
        block = blocks.GetCurrentDataObject()
        if isinstance(block, vtk.vtkUnstructuredGrid):
            cutter = vtk.vtkCutter()
            cutter.SetCutFunction(plane)
            cutter.SetInputData(block)
            cutter.Update()
            cut.AddInputData(cutter.GetOutput())
        elif block.GetNumberOfCells() and blocks.GetCurrentMetaData().Get(vtk.vtkCompositeDataSet.NAME()) != "farfield":
            walls.AddInputData(block)
        blocks.GoToNextItem()
    walls.Update()
    bounds = walls.GetOutput().GetBounds()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for source in (cut, walls):
        speed = vtk.vtkArrayCalculator()
        speed.SetInputConnection(source.GetOutputPort())
        speed.AddVectorArrayName("U")
        speed.SetFunction("mag(U)")
        speed.SetResultArrayName("speed")
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(speed.GetOutputPort())
        mapper.SetScalarModeToUsePointFieldData()
        table = vtk.vtkLookupTable()
        table.SetHueRange(0.667, 0)
        table.Build()
        mapper.SetLookupTable(table)
        mapper.UseLookupTableScalarRangeOff()
        mapper.SetScalarRange(0.5 * SPEED, 1.5 * SPEED)
        mapper.SelectColorArray("speed")
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1400, 700)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    center = [(bounds[2 * k] + bounds[2 * k + 1]) / 2 for k in range(3)]
    camera.SetFocalPoint(center)
    camera.SetPosition(center[0], center[1] - 1, center[2] + 0.35)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera(*bounds)
    camera.Zoom(1.6)
    renderer.ResetCameraClippingRange()
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetInputConnection(shot.GetOutputPort())
    writer.SetFileName(str(image))
    writer.Write()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--program", default=ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--no-picture", action="store_true")
    options = parser.parse_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    ranks = [ROOT / "scripts/mpirun_local.sh", options.ranks]
    (folder / "system").mkdir(exist_ok=True)
    (folder / "system" / "fvSolution").write_text(SOLUTION)
    (folder / "system" / "fvSchemes").write_text(SCHEMES)
    run([*ranks, options.program, "convert", options.mesh.resolve(), folder / "mesh.foam", "--parts",
         options.ranks], folder, "log.convert")
    for rank in range(options.ranks):
        start = folder / f"processor{rank}" / "0"
        start.mkdir(exist_ok=True)
        for name, text in FIELDS.items():
            (start / name).write_text(text)
    checked = run([*ranks, "checkMesh", "-parallel", "-allTopology"], folder, "log.checkMesh")
    text = run([*ranks, "potentialFoam", "-parallel"], folder, "log.potentialFoam")
    residuals = [(float(first), float(last)) for first, last in re.findall(
        r"Solving for Phi, Initial residual = (\S+), Final residual = (\S+),", text)]
    fallen = residuals[-1][0] < 1e-3 * residuals[0][0]
    cells = re.search(r"cells: +(\d+)", checked).group(1)
    if not options.no_picture:
        draw(folder, folder / "speed.png")
    ok = "Mesh OK." in checked
    continuity = re.search(r"Continuity error = (\S+)", text).group(1)
    print(f"RESULT cells={cells} ranks={options.ranks} mesh_ok={int(ok)} solves={len(residuals)} "
          f"first_residual={residuals[0][0]:.3g} last_residual={residuals[-1][0]:.3g} "
          f"continuity={continuity}")
    sys.exit(0 if ok and fallen else 1)


if __name__ == "__main__":
    main()
