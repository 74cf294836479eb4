#!/usr/bin/python3
"""Cuts through a volume mesh, each piece in a colour of its own.

usage: volume_pictures.py MESH.pvtu PREFIX NAME=X,Y,Z,RADIUS,AXIS ...

Each NAME gives PREFIX_NAME.png: the tetrahedra that a plane through the point, normal to the axis (x, y or z), cuts,
and those behind it; RADIUS is the distance to the upper border. Run under xvfb-run where there is no display.
"""
import sys

import vtk
from surface_pictures import colour_pieces, draw


def read(file):
    reader = vtk.vtkXMLPUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


def cut(mesh, point, axis):
    normal = [-1.0 if "xyz"[i] == axis else 0.0 for i in range(3)]
    plane = vtk.vtkPlane()
    plane.SetOrigin(*point)
    plane.SetNormal(*[-n for n in normal])
    extract = vtk.vtkExtractGeometry()
    extract.SetInputData(mesh)
    extract.SetImplicitFunction(plane)
    extract.ExtractBoundaryCellsOn()
    skin = vtk.vtkGeometryFilter()
    skin.SetInputConnection(extract.GetOutputPort())
    skin.Update()
    return skin.GetOutput(), [-n for n in normal]


def main():
    file, prefix = sys.argv[1:3]
    mesh = read(file)
    for view in sys.argv[3:]:
        name, numbers = view.split("=")
        *values, axis = numbers.split(",")
        values = [float(v) for v in values]
        skin, normal = cut(mesh, values[:3], axis)
        colour_pieces(skin)
        draw(skin, values[:3], values[3], [-n for n in normal], f"{prefix}_{name}.png")


if __name__ == "__main__":
    main()
