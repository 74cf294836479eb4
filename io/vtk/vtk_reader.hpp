/// Tetrahedral meshes from VTK files of any origin.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// A mesh as a file has it. n points, m tetrahedra of positive volume in VTK's order where they have any.
struct TetrahedraFile {
  std::vector<double> coordinates;                ///< (n,3)
  std::vector<std::array<std::int32_t, 4>> tets;  ///< (m)
  std::vector<std::int32_t> region;               ///< (m) index into region_names
  std::vector<std::string> region_names;
  std::int64_t turned = 0;   ///< tetrahedra whose vertices came in the opposite order
  std::int64_t ignored = 0;  ///< cells of lower dimension
};

/// Reads the tetrahedra of a .vtu, .pvtu or (legacy) .vtk file. Points with equal `global_id` are one; points
/// that no tetrahedron uses are dropped. Regions come from the first cell array of integers among `region`,
/// `CellEntityIds`, `gmsh:geometrical` and `medit:ref`; without one there is one region. Throws
/// std::runtime_error naming the file and what is wrong: unreadable, no tetrahedra, other cells of volume,
/// a coordinate that is no number, more cells than a piece may hold.
TetrahedraFile read_tetrahedra(const std::string& path);

}  // namespace aeroloom::io
