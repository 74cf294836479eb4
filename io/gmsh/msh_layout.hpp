/// The place of everything in a binary MSH 4.1 file. It follows from counts alone.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::io {

/// Gmsh's numbers of the shapes (column `type` of $Elements).
inline constexpr std::array<std::int32_t, cell_shape_count> msh_cell_type = {4, 7, 6, 5};
inline constexpr std::array<std::int32_t, face_shape_count> msh_face_type = {2, 3};

/// The elements of one shape in one entity.
struct MshBlock {
  std::int32_t dimension = 3, entity = 1, type = 4, corners = 4;
  std::int64_t count = 0;
  std::int64_t first_tag = 1;  ///< tag of the first element; the tags are consecutive
  std::int64_t offset = 0;     ///< of the head of the block, in bytes after the head of $Elements

  std::int64_t record_bytes() const { return 8 * (1 + std::int64_t{corners}); }
  std::int64_t record(std::int64_t i) const { return offset + head_bytes + i * record_bytes(); }
  static constexpr std::int64_t head_bytes = 3 * 4 + 8;
};

/// The blocks of the whole mesh: surfaces (patch + 1), then volumes (region + 1), by shape, then entity.
/// Entities without elements have no block in the file.
struct MshBlocks {
  std::vector<std::array<MshBlock, face_shape_count>> faces;  ///< by patch
  std::vector<std::array<MshBlock, cell_shape_count>> cells;  ///< by region
  std::int64_t written = 0, elements = 0, bytes = 0;          ///< `written`: blocks in the file
};
MshBlocks lay_out_elements(const std::vector<std::array<mesh::GlobalIndex, face_shape_count>>& patch_faces,
                           const std::vector<std::array<mesh::GlobalIndex, cell_shape_count>>& region_cells);

/// Offsets in bytes from the beginning of a file with n vertices, all in one block.
struct MshLayout {
  std::int64_t nodes = 0;     ///< "$Nodes"
  std::int64_t tags = 0;      ///< (n) int64
  std::int64_t points = 0;    ///< (n,3) double
  std::int64_t elements = 0;  ///< "$EndNodes" and "$Elements"
  std::int64_t blocks = 0;    ///< the origin of MshBlock::offset
  std::int64_t end = 0;       ///< "$EndElements"
};
MshLayout lay_out_file(std::int64_t head_bytes, std::int64_t vertices, const MshBlocks& blocks);

inline constexpr char msh_nodes_begin[] = "$Nodes\n";
inline constexpr char msh_nodes_end[] = "\n$EndNodes\n$Elements\n";
inline constexpr char msh_elements_end[] = "\n$EndElements\n";

}  // namespace aeroloom::io
