/// Regions and patches as VTK files tell them. Included by io/vtk/*.cpp alone: it names VTK.
#pragma once

#include "io/vtk/vtk_part.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkUnstructuredGrid.h>

namespace aeroloom::io {

/// Cell arrays of whole numbers that tell regions apart; the first one there counts. They are of our own
/// files; of meshio for Gmsh's physical groups; of Gmsh itself; of meshio again.
inline constexpr std::array<const char*, 5> region_arrays = {"region", "gmsh:physical", "CellEntityIds",
                                                             "gmsh:geometrical", "medit:ref"};
/// Labels of patches.
inline constexpr std::array<const char*, 5> patch_arrays = {"patch", "gmsh:physical", "CellEntityIds",
                                                            "gmsh:geometrical", "medit:ref"};

/// The `count` values of an array of one component; nothing where they are not that many or not whole.
std::optional<std::vector<std::int64_t>> integers_of(vtkDataArray& array, vtkIdType count);

/// The labels of some cells of a grid, and a table of those in use.
struct CellLabels {
  std::vector<std::vector<std::int32_t>> of_cells;  ///< per list of cells, places in the table
  std::vector<VtkLabel> table;
};
/// Of lists of cells of a grid.
CellLabels read_regions(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists);
CellLabels read_patches(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists);

/// Whether field arrays hold boundary faces (io/vtk/vtk_writer.hpp).
bool has_boundary_fields(vtkFieldData& fields);
/// Fills faces, their labels and `patches` from them. Throws std::runtime_error where they do not fit
/// together.
void read_boundary_fields(vtkFieldData& fields, VtkPart& part);

}  // namespace aeroloom::io
