#include "layers/wanted_layers.hpp"

#include "layers/column_heights.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace aeroloom::layers {
namespace {

VertexLayers layers_of(const WallLayers& wanted) {
  VertexLayers asked;
  asked.first = wanted.first;
  asked.growth = wanted.growth;
  asked.total = wanted.total > 0 ? wanted.total : std::numeric_limits<double>::infinity();
  asked.count = wanted.count > 0 ? wanted.count : most_layers;
  asked.constant = wanted.constant;
  return asked;
}

VertexLayers both(const VertexLayers& a, const VertexLayers& b) {
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

/// The front over a stretched triangle is to be as wide as that is long: all its sides count as the long
/// ones.
void lengthen_short(std::array<double, 3>& sides) {
  if (!is_stretched(sides)) return;
  std::array sorted = sides;
  std::sort(sorted.begin(), sorted.end());
  sides.fill(sorted[1]);
}

}  // namespace

std::array<double, 3> sides_of(const LocalWall& wall, std::int32_t triangle) {
  const auto& [a, b, c] = wall.triangles[triangle];
  return {distance(wall.points[a], wall.points[b]), distance(wall.points[b], wall.points[c]),
          distance(wall.points[c], wall.points[a])};
}

bool is_stretched(const std::array<double, 3>& sides) {
  constexpr double least_stretch = 2.5;
  const auto [shortest, longest] = std::minmax({sides[0], sides[1], sides[2]});
  return longest > least_stretch * shortest;
}

std::vector<VertexLayers> gather_wanted_layers(const LocalWall& wall, const LayerOptions& options) {
  std::vector<VertexLayers> all_wanted(wall.points.size());
  for (std::int32_t t = 0; t < wall.triangle_count(); ++t) {
    if (wall.roles[t] != WallRole::layered) continue;
    VertexLayers asked = layers_of(options.patches[wall.patches[t]]);
    asked.edges = 2;
    const auto& [a, b, c] = wall.triangles[t];
    std::array<double, 3> sides = sides_of(wall, t);
    if (options.bends_columns) lengthen_short(sides);
    asked.edge_sum = sides[2] + sides[0], all_wanted[a] = both(all_wanted[a], asked);
    asked.edge_sum = sides[0] + sides[1], all_wanted[b] = both(all_wanted[b], asked);
    asked.edge_sum = sides[1] + sides[2], all_wanted[c] = both(all_wanted[c], asked);
  }
  wall.combine(all_wanted, both);
  return all_wanted;
}

std::vector<double> smooth_mean_edges(const LocalWall& wall, const std::vector<VertexLayers>& wanted) {
  constexpr int sweeps = 8;  // as many as directions have; chosen, not measured
  struct Around {
    double edges;
    std::int64_t count;
  };
  std::vector<double> smooth(wanted.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) smooth[v] = wanted[v].mean_edge();
  std::vector<Around> around(wanted.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
      around[v] = {};
      wall.for_each_neighbour(v, [&](std::int32_t u) { around[v].edges += smooth[u], ++around[v].count; });
    }
    wall.combine(around, [](Around a, Around b) { return Around{a.edges + b.edges, a.count + b.count}; });
    for (std::size_t v = 0; v < wanted.size(); ++v) {
      if (around[v].count == 0) continue;
      smooth[v] = 0.5 * (smooth[v] + around[v].edges / static_cast<double>(around[v].count));
    }
  }
  return smooth;
}

WallLayers VertexLayers::as_of_patch() const {
  const bool is_limited = total < std::numeric_limits<double>::infinity();
  return {first, growth, static_cast<std::int32_t>(constant), static_cast<std::int32_t>(count),
          is_limited ? total : 0};
}

std::vector<FittedLayers> fit_wanted_layers(const std::vector<VertexLayers>& wanted,
                                            const std::vector<double>& edges) {
  std::vector<FittedLayers> fitted(wanted.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    if (wanted[v].edges > 0) fitted[v] = wanted_layers(wanted[v].as_of_patch(), edges[v]);
  }
  return fitted;
}

double wanted_height(const VertexLayers& wanted, const FittedLayers& fitted) {
  const auto constant = static_cast<std::int32_t>(wanted.constant);
  return Heights{wanted.first, wanted.growth, constant, fitted.regular, fitted.stretch}.total(fitted.count);
}

}  // namespace aeroloom::layers
