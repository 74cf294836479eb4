#include "surface/division/graph_partition.hpp"

#include <stdexcept>
#include <string>

#include <metis.h>

namespace aeroloom::partition {

std::vector<std::int32_t> partition_graph(const WeightedGraph& graph, std::int32_t parts) {
  static_assert(sizeof(idx_t) == sizeof(std::int32_t), "METIS is built with 32-bit indices");
  // Any seed does, as long as it is the same everywhere; loads may be off by 3 %, the default of METIS where
  // it cuts into many parts at once.
  constexpr idx_t seed = 20130, tolerance = 30;
  constexpr std::int32_t few_parts = 8;  // where recursive bisection cuts less
  auto nodes = static_cast<idx_t>(graph.node_weights.size());
  std::vector<std::int32_t> part(nodes, 0);
  if (parts <= 1 || nodes <= 1) return part;
  idx_t constraints = 1, wanted = parts, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = seed;
  options[METIS_OPTION_UFACTOR] = tolerance;
  options[METIS_OPTION_NUMBERING] = 0;
  const auto run = parts <= few_parts ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  // The interface takes pointers to what it does not change.
  const auto data = [](const std::vector<std::int32_t>& items) { return const_cast<idx_t*>(items.data()); };
  const int status =
      run(&nodes, &constraints, data(graph.first), data(graph.neighbours), data(graph.node_weights), nullptr,
          data(graph.arc_weights), &wanted, nullptr, nullptr, options, &cut, part.data());
  if (status != METIS_OK) throw std::runtime_error("METIS failed with status " + std::to_string(status));
  return part;
}

}  // namespace aeroloom::partition
