#include "layers/wanted_layers.hpp"

#include "layers/column_heights.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::layers {
namespace {

VertexWish wish_of(const WallLayers& wanted) {
  VertexWish wish;
  wish.first = wanted.first;
  wish.growth = wanted.growth;
  wish.total = wanted.total > 0 ? wanted.total : std::numeric_limits<double>::infinity();
  wish.count = wanted.count > 0 ? wanted.count : most_layers;
  wish.constant = wanted.constant;
  return wish;
}

VertexWish both(const VertexWish& a, const VertexWish& b) {
  if (a.edges == 0) return b;
  if (b.edges == 0) return a;
  return {std::min(a.first, b.first),
          std::min(a.growth, b.growth),
          std::min(a.total, b.total),
          a.edge_sum + b.edge_sum,
          a.edges + b.edges,
          std::min(a.count, b.count),
          std::min(a.constant, b.constant)};
}

}  // namespace

std::vector<VertexWish> gather_wishes(const Wall& wall, const LayerOptions& options) {
  std::vector<VertexWish> wishes(wall.points.size());
  for (std::int32_t t = 0; t < wall.triangle_count(); ++t) {
    if (wall.roles[t] != WallRole::layered) continue;
    VertexWish wish = wish_of(options.patches[wall.patches[t]]);
    wish.edges = 2;
    const auto& [a, b, c] = wall.triangles[t];
    const double ab = distance(wall.points[a], wall.points[b]), bc = distance(wall.points[b], wall.points[c]),
                 ca = distance(wall.points[c], wall.points[a]);
    wish.edge_sum = ca + ab, wishes[a] = both(wishes[a], wish);
    wish.edge_sum = ab + bc, wishes[b] = both(wishes[b], wish);
    wish.edge_sum = bc + ca, wishes[c] = both(wishes[c], wish);
  }
  wall.combine(wishes, both);
  return wishes;
}

}  // namespace aeroloom::layers
