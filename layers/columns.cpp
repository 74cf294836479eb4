#include "aeroloom/layers/columns.hpp"

namespace aeroloom::layers {

double height(const PieceColumns& columns, mesh::LocalIndex vertex, std::int32_t k) {
  double sum = 0, next = columns.first[vertex];
  for (std::int32_t j = 1; j <= k; ++j) {
    if (j > columns.constant[vertex]) next *= columns.growth[vertex];
    sum += next;
  }
  return sum;
}

geometry::Vec3 node(const mesh::Piece& wall, const PieceColumns& columns, mesh::LocalIndex vertex,
                    std::int32_t k) {
  if (k == 0) return wall.point(vertex);
  return wall.point(vertex) + height(columns, vertex, k) * columns.directions[vertex];
}

}  // namespace aeroloom::layers
