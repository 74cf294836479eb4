/// Calls VTK's readers. Only io/vtk/*.cpp include this header.
#pragma once

#include <string>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace aeroloom::io {

/// The grid of a .vtu or legacy .vtk file as VTK reads it. Of a .vtu only the cell arrays in
/// io/vtk/vtk_labels.hpp are read. Throws std::runtime_error with the first error of VTK.
vtkSmartPointer<vtkUnstructuredGrid> read_vtk_grid(const std::string& path);

}  // namespace aeroloom::io
