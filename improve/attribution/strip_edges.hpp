/// Which of a list of edges run across a strip of a CAD face that is finer than its elements.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <compare>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::attribution {

/// An edge between vertices on curves, as one region sees it.
struct EdgeName {
  mesh::GlobalIndex low, high;
  std::int64_t region;

  static constexpr auto fields() { return std::tuple(&EdgeName::low, &EdgeName::high, &EdgeName::region); }
  auto operator<=>(const EdgeName&) const = default;
};

/// An edge across a strip.
struct StripEdge {
  std::int64_t edge;  ///< its number in the list
  std::int32_t face;
  double width;       ///< of the narrowest triangle of the strip that has the edge
  geometry::Vec3 at;  ///< its middle

  static constexpr auto fields() {
    return std::tuple(&StripEdge::edge, &StripEdge::face, &StripEdge::width, &StripEdge::at);
  }
};

/// The edges (ascending, the same on every rank) that belong to strip triangles and run from one
/// curve to the other: by number, each once, the same on every rank. Collective.
std::vector<StripEdge> find_strip_edges(const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                                        const std::vector<EdgeName>& edges);

/// The one with the number, null where there is none.
const StripEdge* find_strip_edge(const std::vector<StripEdge>& strips, std::int64_t edge);

}  // namespace aeroloom::attribution
