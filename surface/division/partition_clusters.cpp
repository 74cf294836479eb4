#include "surface/division/partition_clusters.hpp"

#include "geometry/runs.hpp"
#include "surface/division/graph_partition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aeroloom::partition {
namespace {

/// Weights are whole numbers for METIS: the sum of loads, and an arc as long as one fine edge, are about so
/// much.
constexpr double total_weight = 2e6, edge_weight = 20;
/// One arc's weight, and that of arcs between two clusters together, at most: METIS counts in 32 bits.
constexpr double most_of_arc = 1e6, most_of_arcs = 1e8;
/// The area of an equilateral triangle over the square of its edge: elements per area to elements per length.
constexpr double triangle_over_square = 0.433;

/// The dual graph of the clusters. An arc weighs as much as the fine edges a cut there has.
WeightedGraph cluster_graph(const BackgroundSurface& surface, const Clusters& clusters) {
  const auto density = [&](TriangleIndex t) {
    const auto& [a, b, c] = surface.triangles[t];
    const geometry::Vec3 p = surface.points[a];
    const double area = 0.5 * norm(cross(surface.points[b] - p, surface.points[c] - p));
    return area > 0 ? surface.loads[t] / area : 0;
  };
  struct Arc {
    ClusterIndex from, to;
    double weight;
  };
  std::vector<Arc> arcs;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(surface.twins.size()); ++h) {
    const geometry::HalfEdge twin = surface.twins[h];
    if (twin < 0) continue;
    const ClusterIndex from = clusters.of_triangle[h / 3], to = clusters.of_triangle[twin / 3];
    if (from == to) continue;
    const double length = distance(surface.points[surface.start(h)], surface.points[surface.end(h)]);
    const double density_there = 0.5 * (density(h / 3) + density(twin / 3));
    arcs.push_back({from, to, edge_weight * length * std::sqrt(triangle_over_square * density_there)});
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) {
    return std::array{a.from, a.to} < std::array{b.from, b.to};
  });
  WeightedGraph graph;
  const std::size_t nodes = clusters.loads.size();
  const double total = std::accumulate(clusters.loads.begin(), clusters.loads.end(), 0.0);
  for (const double load : clusters.loads)
    graph.node_weights.push_back(std::max(1, static_cast<std::int32_t>(load / total * total_weight)));
  graph.first.assign(nodes + 1, 0);
  const auto same_ends = [](const Arc& a, const Arc& b) { return a.from == b.from && a.to == b.to; };
  geometry::for_each_run(std::span<const Arc>(arcs), same_ends, [&](std::size_t first, std::size_t last) {
    double weight = 0;
    // The two directions of an arc add the same terms in another order: rounded, they must agree.
    for (std::size_t i = first; i < last; ++i)
      weight += std::max(1.0, std::round(std::min(arcs[i].weight, most_of_arc)));
    graph.neighbours.push_back(arcs[first].to);
    graph.arc_weights.push_back(static_cast<std::int32_t>(std::min(weight, most_of_arcs)));
    ++graph.first[arcs[first].from + 1];
  });
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  return graph;
}

}  // namespace

std::vector<PartIndex> partition_clusters(const BackgroundSurface& surface, const Clusters& clusters,
                                          PartIndex parts) {
  parts = std::min(parts, static_cast<PartIndex>(surface.triangles.size()));
  const std::vector<PartIndex> of_cluster = partition_graph(cluster_graph(surface, clusters), parts);
  std::vector<PartIndex> part(surface.triangles.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = of_cluster[clusters.of_triangle[t]];
  return part;
}

}  // namespace aeroloom::partition
