/// The metadata of a VTKHDF file, read without its large arrays.
#pragma once

#include "io/vtkhdf/vtkhdf_layout.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io::vtkhdf {

struct FileFacts {
  std::vector<GridCounts> before;  ///< sums over the partitions before each; a last entry for all
  std::string id_array;            ///< path of the ids of points, or empty
  bool has_regions = false, has_patches = false, has_ghosts = false;  ///< whether it has such cell data
  bool has_boundary = false;
  std::int64_t boundary_faces = 0, boundary_corners = 0;
  std::vector<std::string> region_names, patch_names, patch_types;  ///< from /Boundary if it exists
  const GridCounts& all() const { return before.back(); }
  std::size_t partition_count() const { return before.size() - 1; }
};

/// Throws std::runtime_error for damage, and std::ios_base::failure where the file cannot be
/// opened. Not collective.
FileFacts survey_file(const std::string& path);

}  // namespace aeroloom::io::vtkhdf
