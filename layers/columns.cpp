#include "layers/columns.hpp"

#include "layers/column_heights.hpp"

namespace aeroloom::layers {

Heights heights(const PieceColumns& columns, mesh::LocalIndex vertex) {
  return {columns.first[vertex], columns.growth[vertex], columns.constant[vertex], columns.regular[vertex],
          columns.stretch[vertex]};
}

double height(const PieceColumns& columns, mesh::LocalIndex vertex, std::int32_t k) {
  return heights(columns, vertex).total(k);
}

geometry::Vec3 node(const mesh::Piece& wall, const PieceColumns& columns, mesh::LocalIndex vertex,
                    std::int32_t k) {
  return wall.point(vertex) + height(columns, vertex, k) * columns.directions[vertex];
}

std::string_view name_of(LayerLimit limit) {
  static constexpr std::array<std::string_view, layer_limit_count> names = {
      "none", "no_direction", "ending", "gap", "validity", "slope", "crossing"};
  return names[static_cast<std::size_t>(limit)];
}

}  // namespace aeroloom::layers
