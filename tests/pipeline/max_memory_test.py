#!/usr/bin/env python3
"""--max-memory: what does not fit ends on all ranks with code 8 and a message; what fits gives the same mesh.
usage: max_memory_test.py PROGRAM"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

from program import COARSE_DUCT, COARSE_TRANSPORT, COARSE_WING, NO_PICTURES, SOURCE

STEPS = 44  # of a cube's side: large enough for what does not fit to be the mesh, not the program


def write_large(file):
    """Half a million tetrahedra, six in each of so many cubes, as another program writes them."""
    side = STEPS + 1
    grid = numpy.stack(numpy.meshgrid(*3 * [numpy.arange(side)], indexing="ij"), axis=-1)
    points = grid.reshape(-1, 3).astype(float)
    first = (grid[:-1, :-1, :-1] * (side * side, side, 1)).sum(axis=-1).reshape(-1)
    far = first + side * side + side + 1
    cells = []
    for steps in itertools.permutations((side * side, side, 1)):
        cells.append(numpy.stack([first, first + steps[0], first + steps[0] + steps[1], far], axis=1))
    corners = numpy.concatenate(cells)
    result = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    result.SetPoints(places)
    table = vtk.vtkCellArray()
    table.SetData(4, numpy_to_vtkIdTypeArray(corners.reshape(-1), deep=True))
    result.SetCells(vtk.VTK_TETRA, table)
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(result)
    writer.SetCompressorTypeToNone()
    writer.Write()


def finest(size):
    """Settings of the program for elements of this size on the body."""
    return [word for key in ("minimum", "feature_minimum", "surface_maximum") for word in ("--set", f"sizing.{key}={size}")]


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_memory_"))
    (folder / "duct.yaml").write_text(COARSE_DUCT + NO_PICTURES)
    (folder / "case.yaml").write_text(COARSE_WING + NO_PICTURES)
    (folder / "aircraft.yaml").write_text(COARSE_TRANSPORT)
    write_large(folder / "large.vtu")

    def run(ranks, *line):
        done = subprocess.run([SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, *line], cwd=folder,
                              capture_output=True, text=True, timeout=200)
        return done.returncode, done.stdout + done.stderr

    def report():
        return json.loads((folder / "out" / "report.json").read_text())

    def expect(code, words, ranks, *line):
        found, text = run(ranks, *line)
        assert found == code and all(word in text for word in words), f"{ranks} rank(s), {line}: {found}\n{text}"
        return text

    expect(0, ["hash"], 2, "run", "duct.yaml")
    free = report()["mesh"]["hash"]
    expect(0, [free], 2, "run", "duct.yaml", "--max-memory", "4G")
    # Known to be too little before anything is done.
    expect(8, ["--max-memory"], 1, "check", "case.yaml", "--max-memory", "1M")
    # The tetrahedra alone would fit.
    expect(8, ["tetrahedra and", "cells of layers are predicted", "would fit"], 1, "run", "case.yaml", *finest(0.06), "--set",
           "layers.first=1e-4", "--max-memory", "150M")
    for ranks in (1, 2):
        # Known to be too much once sizes are known.
        expect(8, ["stage sizing failed", "are predicted", "would fit", "--max-memory"], ranks, "run", "case.yaml", *finest(0.04),
               "--max-memory", f"{120 * ranks}M")
        assert (report()["status"], report()["exit_code"]) == ("failed", 8)
        # Out of memory on the way: in a sandboxed run, and in the ranks.
        text = expect(8, ["stage geometry failed: out of memory", "--max-memory"], ranks, "run", "aircraft.yaml",
                      "--max-memory", f"{45 * ranks}M")
        assert text.count("error") == 1, text
        expect(8, ["out of memory", "--max-memory"], ranks, "convert", "large.vtu", "big.cgns", "--max-memory",
               f"{50 * ranks}M")
        assert not (folder / "big.cgns").exists()
        expect(0, ["wrote"], ranks, "convert", "out/mesh.pvtu", "mesh.cgns", "--max-memory", "60%")
        expect(8, ["out of memory", "1 rank(s)" if ranks == 1 else "2 rank(s)"], ranks, "improve", "large.vtu",
               "--set", "output.directory=better", "--max-memory", f"{50 * ranks}M")


if __name__ == "__main__":
    main()
