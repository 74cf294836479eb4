/// Ghosts: the blocks of other ranks that this rank needs.
#pragma once

#include "geometry/runs.hpp"
#include "mesh/exchange/delivery.hpp"
#include "volume/lattice/lattice.hpp"

#include <span>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// A query of one rank to another, for blocks or triangles that touch a box or are near it.
struct BlockQuery {
  GridBox box;
  double least = 0, most = 0;  ///< radii, see BlockSearchRadii
  std::int32_t level = 0;      ///< of the block that the query is for
  parallel::Rank to = 0, from = 0;
};

/// Collects the queries of a rank, and exchanges them.
class BlockQueries {
public:
  /// Refers to the tree.
  explicit BlockQueries(const LatticeTree& tree) : _tree(tree) {}

  /// Adds a query to each other rank with blocks that touch `where`.
  void add(const GridBox& where, BlockQuery query);
  /// Sends the queries. Calls answer(queries) once for each rank that sends some here, in ascending order of
  /// ranks. Collective.
  template <class Answer>
  void exchange(const Answer& answer) {
    const std::vector<BlockQuery> arrived =
        mesh::deliver(_tree.communicator(), std::move(_queries), [](const BlockQuery& q) { return q.to; });
    const std::span<const BlockQuery> all(arrived);
    geometry::for_each_run(
        all, [](const BlockQuery& a, const BlockQuery& b) { return a.from == b.from; },
        [&](std::size_t first, std::size_t last) { answer(all.subspan(first, last - first)); });
  }

private:
  const LatticeTree& _tree;
  std::vector<BlockQuery> _queries;
};

/// A block of another rank.
struct GhostBlock {
  PackedBlock block;
  float longest_edge;  ///< see SurfaceTable
};

/// All blocks that touch blocks of this rank or contain corners of its triangles. Collective.
std::vector<GhostBlock> fetch_ghosts(const Lattice& lattice);
/// From each rank within finer_search_radii() of an own block: a surface block four or more levels finer, if
/// any. Collective.
std::vector<GhostBlock> fetch_finer_ghosts(const Lattice& lattice);

}  // namespace aeroloom::volume
