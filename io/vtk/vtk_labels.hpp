/// Finds the regions and patches of a VTK file. Only io/vtk/*.cpp include this header.
#pragma once

#include "io/vtk/vtk_content.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkUnstructuredGrid.h>

namespace aeroloom::io {

/// Cell arrays of whole numbers that identify regions; the first one in a file counts. In this order they
/// come from this program, meshio (Gmsh's physical groups), Gmsh, and meshio again (twice).
inline constexpr std::array<const char*, 5> region_arrays = {"region", "gmsh:physical", "CellEntityIds",
                                                             "gmsh:geometrical", "medit:ref"};
/// Cell arrays that identify patches, likewise.
inline constexpr std::array<const char*, 5> patch_arrays = {"patch", "gmsh:physical", "CellEntityIds",
                                                            "gmsh:geometrical", "medit:ref"};

/// The `count` values of an array of one component; empty unless there are `count` whole numbers.
std::optional<std::vector<std::int64_t>> integers_of(vtkDataArray& array, vtkIdType count);

/// The labels of some cells of a grid, and the table of the labels in use.
struct CellLabels {
  std::vector<std::vector<std::int32_t>> of_cells;  ///< by list of cells: indices in the table
  std::vector<VtkLabel> table;
};
/// The regions, or patches, of lists of cells of a grid.
CellLabels read_regions(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists);
CellLabels read_patches(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists);

/// Whether the field arrays hold boundary faces as write_volume() stores them (io/vtk/vtk_writer.hpp).
bool has_boundary_fields(vtkFieldData& fields);
/// Reads faces, their labels and the patches from these arrays. Throws std::runtime_error where the arrays
/// contradict each other.
void read_boundary_fields(vtkFieldData& fields, VtkContent& content);

}  // namespace aeroloom::io
