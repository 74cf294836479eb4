/// VTK's own readers. Included by io/vtk/*.cpp alone: it names VTK.
#pragma once

#include <string>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace aeroloom::io {

/// The grid of a .vtu or legacy .vtk file as VTK reads it; of a .vtu, only the cell arrays that matter
/// (io/vtk/vtk_labels.hpp). Throws std::runtime_error with VTK's first complaint.
vtkSmartPointer<vtkUnstructuredGrid> read_vtk_grid(const std::string& path);

}  // namespace aeroloom::io
