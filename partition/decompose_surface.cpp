#include "partition/decompose_surface.hpp"

#include "partition/graph_partition.hpp"
#include "partition/repair_parts.hpp"
#include "partition/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aeroloom::partition {
namespace {

/// No cluster is heavier than this part of a piece, so that pieces can be balanced.
constexpr double largest_cluster = 0.15;
constexpr int repair_rounds = 6;
/// Weights are whole numbers for METIS: the sum of loads, and an arc as long as one fine edge, are about so
/// much.
constexpr double total_weight = 2e6, edge_weight = 20;

/// The dual graph of the clusters. An arc weighs as much as the fine edges a cut there has.
WeightedGraph cluster_graph(const BackgroundSurface& surface, const Clusters& clusters) {
  const auto density = [&](std::int32_t t) {
    const auto& [a, b, c] = surface.triangles[t];
    const geometry::Vec3 p = surface.points[a];
    const double area = 0.5 * norm(cross(surface.points[b] - p, surface.points[c] - p));
    return area > 0 ? surface.loads[t] / area : 0;
  };
  struct Arc {
    std::int32_t from, to;
    double weight;
  };
  std::vector<Arc> arcs;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(surface.twins.size()); ++h) {
    const geometry::HalfEdge twin = surface.twins[h];
    if (twin < 0) continue;
    const std::int32_t from = clusters.of_triangle[h / 3], to = clusters.of_triangle[twin / 3];
    if (from == to) continue;
    const double length = distance(surface.points[surface.start(h)], surface.points[surface.end(h)]);
    const double density_there = 0.5 * (density(h / 3) + density(twin / 3));
    arcs.push_back({from, to, edge_weight * length * std::sqrt(0.433 * density_there)});
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) {
    return std::array{a.from, a.to} < std::array{b.from, b.to};
  });
  WeightedGraph graph;
  const std::size_t nodes = clusters.loads.size();
  const double total = std::accumulate(clusters.loads.begin(), clusters.loads.end(), 0.0);
  for (const double load : clusters.loads) {
    graph.node_weights.push_back(std::max(1, static_cast<std::int32_t>(load / total * total_weight)));
  }
  graph.first.assign(nodes + 1, 0);
  for (std::size_t i = 0; i < arcs.size();) {
    double weight = 0;
    std::size_t end = i;
    // The two directions of an arc add the same terms in another order: rounded, they must agree.
    while (end < arcs.size() && arcs[end].from == arcs[i].from && arcs[end].to == arcs[i].to) {
      weight += std::max(1.0, std::round(std::min(arcs[end].weight, 1e6)));
      ++end;
    }
    graph.neighbours.push_back(arcs[i].to);
    graph.arc_weights.push_back(static_cast<std::int32_t>(std::min(weight, 1e8)));
    ++graph.first[arcs[i].from + 1];
    i = end;
  }
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  return graph;
}

/// Numbers the parts by first triangle; empty ones vanish.
SurfaceDecomposition number_parts(const std::vector<std::int32_t>& part) {
  SurfaceDecomposition result;
  result.parts = 0;
  std::vector<std::int32_t> number(part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1, -1);
  for (const std::int32_t p : part) {
    if (number[p] < 0) number[p] = result.parts++;
    result.part.push_back(number[p]);
  }
  return result;
}

}  // namespace

SurfaceDecomposition decompose_surface(const BackgroundSurface& surface,
                                       const SurfaceDecompositionOptions& options) {
  const double total = std::accumulate(surface.loads.begin(), surface.loads.end(), 0.0);
  const auto parts = static_cast<std::int32_t>(
      std::clamp(std::round(total / options.piece_load), 1.0, double(surface.triangles.size())));
  if (parts == 1) return {std::vector<std::int32_t>(surface.triangles.size(), 0), 1};
  const VertexFans fans = gather_fans(surface);
  const bool plain = !(options.smallest_angle > 0);
  const Clusters clusters =
      plain ? single_triangles(surface)
            : simplify(surface, fans, {options.smallest_angle, largest_cluster * total / parts});
  const std::vector<std::int32_t> of_cluster = partition_graph(cluster_graph(surface, clusters), parts);
  std::vector<std::int32_t> part(surface.triangles.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = of_cluster[clusters.of_triangle[t]];
  connect_parts(surface, part);
  for (int round = 0; round < repair_rounds && !plain; ++round) {
    const std::int32_t moves = widen_wedges(surface, fans, options.smallest_angle, part);
    connect_parts(surface, part);
    if (moves == 0) break;
  }
  return number_parts(part);
}

}  // namespace aeroloom::partition
