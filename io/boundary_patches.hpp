/// The patches that formats of the boundary alone write, and names that they can hold.
#pragma once

#include "io/file_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// The patches that bound the mesh (not `interior`) and have faces, in their order.
struct BoundaryPatches {
  std::vector<std::int32_t> ids;     ///< of FileMesh::patches
  std::vector<std::int32_t> places;  ///< by id of patch: its place in `ids`, -1 of others
  /// By place and shape of face: how many faces of the shape lower places have; one more at the end.
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> before;

  std::size_t size() const { return ids.size(); }
};
BoundaryPatches boundary_patches(const FileMesh& mesh);

/// Names that a format allows.
struct NameRule {
  std::string_view signs;                        ///< besides letters, digits and what is beyond ASCII
  std::size_t most_bytes = 1U << 16;             ///< of UTF-8
  std::span<const std::string_view> reserved{};  ///< that mean something else
};
/// One name for each, all different: what is not allowed becomes `_`, long ones are cut between characters,
/// empty ones become `patch`, and the later of equal ones get `_2`, `_3` and so on. Names that fit and are
/// unique stay.
std::vector<std::string> plain_names(std::span<const std::string> names, const NameRule& rule);

}  // namespace aeroloom::io
