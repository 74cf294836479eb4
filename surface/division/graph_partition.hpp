/// Multilevel graph partition by METIS (Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998,
/// doi:10.1137/S1064827595287997), serial and seeded.
#pragma once

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// An undirected graph in compressed rows: node i is joined to neighbours[first[i]] ... Both directions of an
/// arc are present, with equal weights.
struct WeightedGraph {
  std::vector<std::int32_t> first;         ///< (nodes + 1)
  std::vector<std::int32_t> neighbours;    ///< per arc
  std::vector<std::int32_t> arc_weights;   ///< per arc, positive
  std::vector<std::int32_t> node_weights;  ///< per node, positive
};

/// Part of each node, 0 to parts - 1; some parts may stay empty in tiny graphs. The same bits for the same
/// graph. Throws std::runtime_error when METIS fails.
std::vector<std::int32_t> partition_graph(const WeightedGraph& graph, std::int32_t parts);

}  // namespace aeroloom::partition
