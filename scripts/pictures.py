#!/usr/bin/python3
"""Pictures of a run for the documentation: the surface with edges, and a cut through the volume near the wing.

usage: pictures.py RUN_DIRECTORY OUTPUT_PREFIX CENTRE_X CENTRE_Y CENTRE_Z RADIUS CUT_Y
Run under xvfb-run where there is no display.
"""
import sys

import vtk


def read(reader, file):
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


def actor(poly, colour):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(poly)
    mapper.ScalarVisibilityOff()
    shown = vtk.vtkActor()
    shown.SetMapper(mapper)
    shown.GetProperty().SetColor(*colour)
    shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(0.15, 0.15, 0.25)
    shown.GetProperty().SetLineWidth(1)
    shown.GetProperty().SetAmbient(0.1)
    shown.GetProperty().SetDiffuse(0.85)
    return shown


def write(actors, centre, towards, up, radius, file):
    scene = vtk.vtkRenderer()
    scene.SetBackground(1, 1, 1)
    for shown in actors:
        scene.AddActor(shown)
    camera = scene.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*[c - 20 * radius * t for c, t in zip(centre, towards)])
    camera.SetViewUp(*up)
    camera.SetParallelScale(radius)
    scene.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1400, 900)
    window.AddRenderer(scene)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(file)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def skin_of(dataset):
    surface = vtk.vtkGeometryFilter()
    surface.SetInputData(dataset)
    surface.Update()
    return surface.GetOutput()


def body_only(surface):
    """The triangles of all patches but `farfield`."""
    names = surface.GetFieldData().GetAbstractArray("patch_names")
    far = [i for i in range(names.GetNumberOfValues()) if names.GetValue(i) == "farfield"]
    if not far:
        return surface
    keep = vtk.vtkThreshold()
    keep.SetInputData(surface)
    keep.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "patch")
    keep.SetThresholdFunction(vtk.vtkThreshold.THRESHOLD_BETWEEN)
    keep.SetLowerThreshold(far[0] - 0.5)
    keep.SetUpperThreshold(far[0] + 0.5)
    keep.InvertOn()
    keep.Update()
    return skin_of(keep.GetOutput())


def main():
    folder, prefix = sys.argv[1:3]
    centre, radius, cut_y = [float(v) for v in sys.argv[3:6]], float(sys.argv[6]), float(sys.argv[7])
    skin = body_only(read(vtk.vtkXMLPPolyDataReader(), folder + "/surface.pvtp"))
    length = sum(v * v for v in (0.6, 0.62, -0.5)) ** 0.5
    view = [v / length for v in (0.6, 0.62, -0.5)]
    write([actor(skin, (0.80, 0.85, 0.92))], centre, view, (0, 0, 1), radius, prefix + "_surface.png")

    plane = vtk.vtkPlane()
    plane.SetOrigin(0, cut_y, 0)
    plane.SetNormal(0, -1, 0)
    cells = vtk.vtkExtractGeometry()
    cells.SetImplicitFunction(plane)
    cells.SetInputData(read(vtk.vtkXMLPUnstructuredGridReader(), folder + "/mesh.pvtu"))
    cells.Update()
    at = [centre[0], cut_y, centre[2]]
    write([actor(skin_of(cells.GetOutput()), (0.93, 0.90, 0.80))], at, (0, 1, 0), (0, 0, 1), radius / 3, prefix + "_cut.png")


if __name__ == "__main__":
    main()
