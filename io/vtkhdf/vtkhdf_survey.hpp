/// A survey of a VTKHDF file, without its large arrays.
#pragma once

#include "io/vtkhdf/vtkhdf_layout.hpp"

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io::vtkhdf {

struct FileFacts {
  std::vector<GridCounts> before;  ///< partitions before each, one entry more than partitions
  std::string id_array;            ///< of points; empty: there is none
  bool has_regions = false, has_patches = false, has_ghosts = false;  ///< cell data
  bool has_boundary = false;
  std::int64_t boundary_faces = 0, boundary_corners = 0;
  std::vector<std::string> region_names, patch_names, patch_types;  ///< of /Boundary where there is one

  static constexpr auto fields() {
    return std::tuple(&FileFacts::before, &FileFacts::id_array, &FileFacts::has_regions,
                      &FileFacts::has_patches, &FileFacts::has_ghosts, &FileFacts::has_boundary,
                      &FileFacts::boundary_faces, &FileFacts::boundary_corners, &FileFacts::region_names,
                      &FileFacts::patch_names, &FileFacts::patch_types);
  }
  const GridCounts& all() const { return before.back(); }
  std::size_t partition_count() const { return before.size() - 1; }
};

/// Throws std::runtime_error, or std::filesystem::filesystem_error where the file cannot be opened. Not
/// collective.
FileFacts survey_file(const std::string& path);

}  // namespace aeroloom::io::vtkhdf
