#include "mesh/data/shared_vertex_keys.hpp"

#include <stdexcept>

namespace aeroloom::mesh {
namespace {

// Surfaces: bit 63 for cuts; with bit 62 31 bits of piece and 31 of vertex, without it 22 bits of face, 16 of
// group, 24 of index. Without bit 63 edge + 1 and index.
constexpr SharedVertexKey cut_bit = SharedVertexKey{1} << 63, split_bit = SharedVertexKey{1} << 62;
constexpr int face_bits = 22, group_bits = 16, index_bits = 24;
constexpr int edge_shift = 32;
// Columns over such a vertex: the uppermost eight bits of its index.
constexpr SharedVertexKey last_column = 0xff;
constexpr int column_of_index = 24, column_of_split = 23, column_of_cut = 16;

// Sides of vertices: five bits below those that tell keys apart, of which the uppermost marks vertices inside
// of a piece.
constexpr int side_bits = 5, side_of_cut = 57, side_of_curve = 58;
constexpr SharedVertexKey last_side = (SharedVertexKey{1} << side_bits) - 1,
                          inside_mark = SharedVertexKey{1} << (side_bits - 1);

// Volumes: bits 63 and 62 for rounds, 8 for the round, 54 for piece and vertex or for a running number.
constexpr SharedVertexKey late_bit = SharedVertexKey{1} << 63, placed_bit = SharedVertexKey{1} << 62,
                          added_bit = SharedVertexKey{1} << 61, layer_bit = SharedVertexKey{1} << 60;
constexpr int round_shift = 54, piece_shift = 31, zone_shift = 32, node_bits = 20;

constexpr SharedVertexKey wide(std::int64_t value) {
  return static_cast<SharedVertexKey>(value);
}

}  // namespace

SharedVertexKey cad_vertex_key(std::int32_t vertex) {
  return wide(vertex);
}

SharedVertexKey curve_vertex_key(std::int32_t edge, std::int32_t index) {
  return (wide(edge) + 1) << edge_shift | wide(index);
}

SharedVertexKey cut_vertex_key(std::int32_t face, std::int32_t group, std::int32_t index) {
  if (face >= 1 << face_bits || group >= 1 << group_bits || index >= 1 << index_bits) {
    throw std::runtime_error(
        "a face is cut into more pieces than vertices on cuts can be named for: ask for larger ones "
        "(SurfaceOptions::piece_triangles)");
  }
  return cut_bit | wide(face) << (group_bits + index_bits) | wide(group) << index_bits | wide(index);
}

SharedVertexKey split_vertex_key(PieceId piece, LocalIndex vertex) {
  return cut_bit | split_bit | wide(piece) << piece_shift | wide(vertex);
}

namespace {

int column_shift(SharedVertexKey vertex) {
  if ((vertex & cut_bit) == 0) return column_of_index;
  return (vertex & split_bit) != 0 ? column_of_split : column_of_cut;
}

}  // namespace

bool can_name_columns(SharedVertexKey vertex) {
  return (vertex >> column_shift(vertex) & last_column) == 0;
}

SharedVertexKey fan_vertex_key(SharedVertexKey vertex, std::int32_t column) {
  if (!can_name_columns(vertex) || wide(column) > last_column)
    throw std::runtime_error("boundary layers: a column over a vertex has no name");
  return vertex | wide(column) << column_shift(vertex);
}

namespace {

int side_shift(SharedVertexKey vertex) {
  return (vertex & cut_bit) != 0 ? side_of_cut : side_of_curve;
}

}  // namespace

bool can_name_sides(SharedVertexKey vertex) {
  return (vertex >> side_shift(vertex) & last_side) == 0;
}

SharedVertexKey side_vertex_key(SharedVertexKey vertex, int side) {
  const SharedVertexKey present = vertex >> side_shift(vertex) & last_side;
  if (side < 0 || side > last_vertex_side || (present != 0 && present != inside_mark))
    throw std::runtime_error("boundary layers: a side of a vertex has no name");
  return vertex | wide(side) << side_shift(vertex);
}

SharedVertexKey vertex_key_of_side(SharedVertexKey side) {
  return side & ~((last_side & ~inside_mark) << side_shift(side));
}

SharedVertexKey inside_vertex_key(PieceId piece, LocalIndex vertex) {
  return split_vertex_key(piece, vertex) | inside_mark << side_of_cut;
}

bool is_cut_vertex_key(SharedVertexKey vertex_key) {
  return (vertex_key & cut_bit) != 0;
}

std::int32_t edge_of_vertex_key(SharedVertexKey vertex_key) {
  if (is_cut_vertex_key(vertex_key)) return -1;
  constexpr SharedVertexKey without_side = (SharedVertexKey{1} << side_of_curve) - 1;
  return static_cast<std::int32_t>((vertex_key & without_side) >> edge_shift) - 1;
}

std::int32_t index_of_vertex_key(SharedVertexKey vertex_key) {
  return static_cast<std::int32_t>(vertex_key & 0xffffffffu);
}

SharedVertexKey running_key(std::int64_t number) {
  return wide(number);
}

SharedVertexKey added_key(std::int32_t zone, std::int64_t index) {
  return added_bit | wide(zone) << zone_shift | wide(index);
}

SharedVertexKey layer_key(std::int64_t number, std::int32_t node) {
  return layer_bit | wide(number) << node_bits | wide(node);
}

SharedVertexKey late_key(int round, PieceId piece, LocalIndex vertex) {
  return late_bit | wide(round) << round_shift | wide(piece) << piece_shift | wide(vertex);
}

SharedVertexKey placed_key(int round, std::int64_t index) {
  return late_bit | placed_bit | wide(round) << round_shift | wide(index);
}

}  // namespace aeroloom::mesh
