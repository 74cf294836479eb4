/// Multilevel graph partition by METIS (Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998,
/// doi:10.1137/S1064827595287997). Serial, with a fixed seed.
#pragma once

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// An undirected graph in compressed rows. The neighbours of node i are neighbours[first[i]] to
/// neighbours[first[i + 1] - 1]. Both directions of an arc are stored, with equal weights.
struct WeightedGraph {
  std::vector<std::int32_t> first;         ///< (nodes + 1)
  std::vector<std::int32_t> neighbours;    ///< per arc
  std::vector<std::int32_t> arc_weights;   ///< per arc, positive
  std::vector<std::int32_t> node_weights;  ///< per node, positive
};

/// The part of each node, 0 to parts - 1. Parts of tiny graphs may be empty. Equal graphs give equal results.
/// Throws std::runtime_error when METIS fails.
std::vector<std::int32_t> partition_graph(const WeightedGraph& graph, std::int32_t parts);

}  // namespace aeroloom::partition
