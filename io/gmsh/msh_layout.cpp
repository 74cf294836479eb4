#include "io/gmsh/msh_layout.hpp"

namespace aeroloom::io {

namespace {

/// Appends a block after those before.
void place_block(MshBlocks& blocks, MshBlock& block) {
  block.first_tag = blocks.elements + 1;
  block.offset = blocks.bytes;
  if (block.count == 0) return;
  ++blocks.written;
  blocks.elements += block.count;
  blocks.bytes += MshBlock::head_bytes + block.count * block.record_bytes();
}

}  // namespace

MshBlocks lay_out_elements(const std::vector<std::array<mesh::GlobalIndex, face_shape_count>>& patch_faces,
                           const std::vector<std::array<mesh::GlobalIndex, cell_shape_count>>& region_cells) {
  MshBlocks blocks;
  blocks.faces.resize(patch_faces.size());
  blocks.cells.resize(region_cells.size());
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    for (std::size_t patch = 0; patch < patch_faces.size(); ++patch) {
      blocks.faces[patch][s] = {2, static_cast<std::int32_t>(patch + 1), msh_face_type[s], corners_of(shape),
                                patch_faces[patch][s]};
      place_block(blocks, blocks.faces[patch][s]);
    }
  }
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    for (std::size_t region = 0; region < region_cells.size(); ++region) {
      blocks.cells[region][s] = {3, static_cast<std::int32_t>(region + 1), msh_cell_type[s],
                                 corners_of(shape), region_cells[region][s]};
      place_block(blocks, blocks.cells[region][s]);
    }
  }
  return blocks;
}

MshLayout lay_out_file(std::int64_t head_bytes, std::int64_t vertices, const MshBlocks& blocks) {
  MshLayout layout;
  layout.nodes = head_bytes;
  layout.tags =
      layout.nodes + static_cast<std::int64_t>(sizeof(msh_nodes_begin) - 1) + 4 * 8 + MshBlock::head_bytes;
  layout.points = layout.tags + 8 * vertices;
  layout.elements = layout.points + 24 * vertices;
  layout.blocks = layout.elements + static_cast<std::int64_t>(sizeof(msh_nodes_end) - 1) + 4 * 8;
  layout.end = layout.blocks + blocks.bytes;
  return layout;
}

}  // namespace aeroloom::io
