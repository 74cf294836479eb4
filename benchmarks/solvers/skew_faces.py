#!/usr/bin/python3
"""Which of the faces that OpenFOAM calls skewed lie at sharp edges of walls. usage: skew_faces.py CASE SURFACE.pvtp [ANGLE]

CASE is a folder after `checkMesh -writeSets vtk`; SURFACE.pvtp is the surface of the same run. A face lies at a sharp edge if it is
no farther from one than its own longest edge; an edge is sharp if its triangles turn by more than ANGLE degrees, 35 by default."""
import pathlib
import sys

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def faces_of(data):
    """Middle, shortest and longest edge of each."""
    points = vtk_to_numpy(data.GetPoints().GetData())
    found = []
    for i in range(data.GetNumberOfCells()):
        ids = data.GetCell(i).GetPointIds()
        corners = points[[ids.GetId(k) for k in range(ids.GetNumberOfIds())]]
        edges = numpy.linalg.norm(corners - numpy.roll(corners, 1, 0), axis=1)
        found.append((corners.mean(0), edges.min(), edges.max(), len(corners)))
    return found


def sharp_edges(surface, angle):
    clean = vtk.vtkCleanPolyData()
    clean.SetInputData(surface)
    clean.ToleranceIsAbsoluteOn()
    clean.SetAbsoluteTolerance(0)
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.SetFeatureAngle(angle)
    edges.FeatureEdgesOn()
    edges.BoundaryEdgesOff()
    edges.ManifoldEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ColoringOff()
    edges.Update()
    return edges.GetOutput()


def distances(points, edges):
    if edges.GetNumberOfCells() == 0:
        return numpy.full(len(points), numpy.inf)
    locator = vtk.vtkCellLocator()
    locator.SetDataSet(edges)
    locator.BuildLocator()
    found = []
    for point in points:
        nearest, cell, part, squared = [0, 0, 0], vtk.mutable(0), vtk.mutable(0), vtk.mutable(0.0)
        locator.FindClosestPoint(point, nearest, cell, part, squared)
        found.append(squared.get() ** 0.5)
    return numpy.array(found)


def main():
    case, surface = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    angle = float(sys.argv[3]) if len(sys.argv) > 3 else 35
    sets = list(case.glob("postProcessing/*/skewFaces/skewFaces.vtp"))
    if not sets:
        sys.exit(f"no skewFaces.vtp below {case}: `checkMesh -writeSets vtk` writes one where faces are skewed")
    faces = faces_of(read(vtk.vtkXMLPolyDataReader(), sets[0]))
    edges = sharp_edges(read(vtk.vtkXMLPPolyDataReader(), surface), angle)
    away = distances([middle for middle, *_ in faces], edges)
    at = sum(1 for distance, (_, _, longest, _) in zip(away, faces) if distance <= longest)
    quadrilaterals = sum(1 for *_, corners in faces if corners == 4)
    aspect = numpy.median([longest / shortest for _, shortest, longest, _ in faces])
    print(f"{len(faces)} skewed faces, {quadrilaterals} of them quadrilaterals, median aspect ratio {aspect:.0f}: {at} at sharp edges, "
          f"{len(faces) - at} elsewhere; {edges.GetNumberOfCells()} sharp edges")
    for distance, (middle, _, longest, _) in sorted(zip(away, faces), key=lambda pair: -pair[0] / pair[1][2])[:5]:
        if distance > longest:
            print(f"  farthest: {middle}, {distance:.4g} from an edge, longest edge {longest:.4g}")


if __name__ == "__main__":
    main()
