/// Patches for formats that hold no faces between regions, and names as a format allows them.
#pragma once

#include "io/file_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// The patches on the boundary of the mesh that have faces, in their order. `interior` patches are left out.
struct BoundaryPatches {
  std::vector<std::int32_t> ids;     ///< indices in FileMesh::patches
  std::vector<std::int32_t> places;  ///< for each patch of the mesh: its index in `ids`, or -1
  /// By index in `ids` and shape of face: the number of such faces in the patches before; one row more.
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> before;

  std::size_t size() const { return ids.size(); }
};
BoundaryPatches boundary_patches(const FileMesh& mesh);

/// What names a format allows.
struct NameRule {
  std::string_view signs;                        ///< allowed besides letters, digits and non-ASCII characters
  std::size_t most_bytes = 1U << 16;             ///< the largest length in UTF-8
  std::span<const std::string_view> reserved{};  ///< names with a meaning of their own in the format
};
/// One name for each of `names`, all different. Forbidden characters become `_`, and empty names `patch`.
/// Names that are too long are cut between characters. Of equal names the later ones get `_2`, `_3`, ...
/// Allowed and unique names stay.
std::vector<std::string> plain_names(std::span<const std::string> names, const NameRule& rule);

}  // namespace aeroloom::io
