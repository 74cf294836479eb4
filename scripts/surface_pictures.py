#!/usr/bin/python3
"""Pictures of a surface mesh, each piece in a colour of its own.

usage: surface_pictures.py SURFACE.pvtp PREFIX BOX NAME=X,Y,Z,RADIUS[,DX,DY,DZ] ...

BOX (xmin,xmax,ymin,ymax,zmin,zmax) keeps the CAD faces that lie inside it: what is around the body goes. Each NAME
gives PREFIX_NAME.png: the surroundings of a point, RADIUS to the upper border, seen along (DX, DY, DZ).
Run under xvfb-run where there is no display.
"""
import colorsys
import sys

import vtk

WIDTH, HEIGHT = 900, 580
LEAST_EDGE_PIXELS = 3  # edges closer than that would blacken the picture


def read(file):
    reader = vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


def faces_inside(surface, box):
    """Cells of the CAD faces that lie inside the box."""
    face = surface.GetCellData().GetArray("face")
    inside = {}
    for cell in range(surface.GetNumberOfCells()):
        low_high = surface.GetCell(cell).GetBounds()
        fits = all(box[2 * i] <= low_high[2 * i] and low_high[2 * i + 1] <= box[2 * i + 1] for i in range(3))
        key = int(face.GetTuple1(cell))
        inside[key] = inside.get(key, True) and fits
    ids = vtk.vtkIdTypeArray()
    for cell in range(surface.GetNumberOfCells()):
        if inside[int(face.GetTuple1(cell))]:
            ids.InsertNextValue(cell)
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(ids)
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extract = vtk.vtkExtractSelection()
    extract.SetInputData(0, surface)
    extract.SetInputData(1, selection)
    skin = vtk.vtkGeometryFilter()
    skin.SetInputConnection(extract.GetOutputPort())
    skin.Update()
    return skin.GetOutput()


def colour_pieces(surface):
    piece = surface.GetCellData().GetArray("piece")
    colours = vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    for cell in range(surface.GetNumberOfCells()):
        hue = 0.618034 * piece.GetTuple1(cell) % 1
        colours.InsertNextTuple3(*[255 * c for c in colorsys.hsv_to_rgb(hue, 0.28, 0.96)])
    surface.GetCellData().SetScalars(colours)


def mean_edge(surface):
    """That of equilateral triangles of the same number and area."""
    measure = vtk.vtkMassProperties()
    measure.SetInputData(surface)
    return (4 / 3**0.5 * measure.GetSurfaceArea() / surface.GetNumberOfCells()) ** 0.5


def draw(surface, centre, radius, towards, file):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    shown = vtk.vtkActor()
    shown.SetMapper(mapper)
    if mean_edge(surface) > LEAST_EDGE_PIXELS * 2 * radius / HEIGHT:
        shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(0.15, 0.15, 0.25)
    shown.GetProperty().SetAmbient(0.15)
    shown.GetProperty().SetDiffuse(0.85)
    scene = vtk.vtkRenderer()
    scene.SetBackground(1, 1, 1)
    scene.AddActor(shown)
    camera = scene.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*[c - 20 * radius * t for c, t in zip(centre, towards)])
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(radius)
    scene.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH, HEIGHT)
    window.AddRenderer(scene)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(file)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def main():
    file, prefix, box = sys.argv[1:4]
    surface = faces_inside(read(file), [float(v) for v in box.split(",")])
    colour_pieces(surface)
    for view in sys.argv[4:]:
        name, numbers = view.split("=")
        values = [float(v) for v in numbers.split(",")]
        towards = values[4:7] or [0.6, 0.62, -0.5]
        length = sum(v * v for v in towards) ** 0.5
        draw(surface, values[:3], values[3], [v / length for v in towards], f"{prefix}_{name}.png")


if __name__ == "__main__":
    main()
