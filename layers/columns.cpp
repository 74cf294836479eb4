#include "layers/columns.hpp"

#include "layers/column_heights.hpp"

#include <algorithm>

namespace aeroloom::layers {

Heights heights(const PieceColumns& columns, mesh::LocalIndex vertex) {
  return {columns.first[vertex], columns.growth[vertex], columns.constant[vertex], columns.regular[vertex],
          columns.stretch[vertex]};
}

double height(const PieceColumns& columns, mesh::LocalIndex vertex, std::int32_t k) {
  return heights(columns, vertex).total(k);
}

const geometry::Vec3* PieceColumns::curved_nodes_of(std::int32_t column) const {
  const auto found = std::lower_bound(curved.begin(), curved.end(), std::array{column, 0});
  return found == curved.end() || (*found)[0] != column ? nullptr : &curved_nodes[(*found)[1]];
}

geometry::Vec3 node(const mesh::Piece& wall, const PieceColumns& columns, std::int32_t column,
                    std::int32_t k) {
  const mesh::LocalIndex vertex = columns.vertex_of(column);
  const geometry::Vec3* curved = k > 0 ? columns.curved_nodes_of(column) : nullptr;
  if (curved != nullptr) return curved[k - 1];
  return wall.point(vertex) + height(columns, vertex, k) * columns.directions[column];
}

std::string_view name_of(InnerSides sides) {
  static constexpr std::array<std::string_view, 4> names = {"none", "front", "back", "both"};
  return names[static_cast<std::size_t>(sides)];
}

std::string_view name_of(LayerLimit limit) {
  static constexpr std::array<std::string_view, layer_limit_count> names = {
      "none", "no_direction", "ending", "gap", "validity", "slope", "crossing"};
  return names[static_cast<std::size_t>(limit)];
}

}  // namespace aeroloom::layers
