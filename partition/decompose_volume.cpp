#include "partition/decompose_volume.hpp"

#include "partition/graph_partition.hpp"
#include "partition/repair_volume.hpp"
#include "partition/simplify_volume.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;

/// A cluster does not grow beyond this part of a piece.
constexpr double largest_cluster = 0.15;
/// Weights of nodes add up to less than 2^31.
constexpr double weight_sum = 1e9;

/// Fine triangles an interface across a face would have, about.
std::int32_t interface_weight(const BackgroundVolume& volume, std::int32_t tet, int k) {
  const auto& v = volume.tets[tet];
  const Vec3 a = volume.points[v[(k + 1) % 4]], b = volume.points[v[(k + 2) % 4]],
             c = volume.points[v[(k + 3) % 4]];
  const double h = volume.sizes[tet];
  return 1 + static_cast<std::int32_t>(std::min(1e6, 0.5 * norm(cross(b - a, c - a)) / (0.433 * h * h)));
}

WeightedGraph contracted_graph(const BackgroundVolume& volume, const VolumeClusters& clusters) {
  struct Arc {
    std::int32_t from, to, weight;
  };
  std::vector<Arc> arcs;
  for (std::size_t t = 0; t < volume.tets.size(); ++t) {
    for (int k = 0; k < 4; ++k) {
      const std::int32_t n = volume.neighbours[t][k];
      if (n < static_cast<std::int32_t>(t)) continue;
      const std::int32_t a = clusters.of_tet[t], b = clusters.of_tet[n];
      if (a == b) continue;
      const std::int32_t weight = interface_weight(volume, static_cast<std::int32_t>(t), k);
      arcs.push_back({a, b, weight});
      arcs.push_back({b, a, weight});
    }
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  WeightedGraph graph;
  graph.first.assign(clusters.loads.size() + 1, 0);
  for (std::size_t i = 0, j = 0; i < arcs.size(); i = j) {
    std::int32_t weight = 0;
    for (; j < arcs.size() && arcs[j].from == arcs[i].from && arcs[j].to == arcs[i].to; ++j)
      weight += arcs[j].weight;
    ++graph.first[arcs[i].from + 1];
    graph.neighbours.push_back(arcs[i].to);
    graph.arc_weights.push_back(weight);
  }
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  const double total = std::accumulate(clusters.loads.begin(), clusters.loads.end(), 0.0);
  for (const double load : clusters.loads)
    graph.node_weights.push_back(1 + static_cast<std::int32_t>(weight_sum * load / total));
  return graph;
}

std::int32_t number_by_first(std::vector<std::int32_t>& part) {
  std::vector<std::int32_t> number(1 + *std::max_element(part.begin(), part.end()), -1);
  std::int32_t next = 0;
  for (std::int32_t& p : part) {
    if (number[p] < 0) number[p] = next++;
    p = number[p];
  }
  return next;
}

}  // namespace

VolumeDecomposition decompose_volume(const BackgroundVolume& volume,
                                     const VolumeDecompositionOptions& options) {
  VolumeDecomposition result;
  const EdgeRings rings = gather_rings(volume);
  const double total = std::accumulate(volume.loads.begin(), volume.loads.end(), 0.0);
  const double wanted = total / options.parts;
  const VolumeClusters clusters = simplify(volume, rings, options.smallest_angle, largest_cluster * wanted);
  result.clusters = clusters.count();
  result.largest_cluster = *std::max_element(clusters.loads.begin(), clusters.loads.end()) / wanted;
  result.unresolved = clusters.unresolved;
  const std::vector<std::int32_t> labels = partition_graph(contracted_graph(volume, clusters), options.parts);
  result.part.resize(volume.tets.size());
  for (std::size_t t = 0; t < result.part.size(); ++t) result.part[t] = labels[clusters.of_tet[t]];
  const VolumeRepair repair = repair_parts(volume, rings, clusters, options.smallest_angle, result.part);
  result.moves = repair.moves;
  result.pinches = repair.pinches;
  result.parts = number_by_first(result.part);
  return result;
}

}  // namespace aeroloom::partition
