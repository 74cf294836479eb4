/// Ghosts: blocks of other ranks, as far as they matter to those of this one.
#pragma once

#include "geometry/runs.hpp"
#include "mesh/exchange/delivery.hpp"
#include "volume/lattice/lattice.hpp"

#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// A query of a rank to another for what touches a box, or is near it.
struct BlockQuery {
  GridBox box;
  double least = 0, most = 0;  ///< see BlockSearchRadii
  std::int32_t level = 0;      ///< of the block that it is for
  parallel::Rank to = 0, from = 0;

  static constexpr auto fields() {
    return std::tuple(&BlockQuery::box, &BlockQuery::least, &BlockQuery::most, &BlockQuery::level,
                      &BlockQuery::to, &BlockQuery::from);
  }
};

/// The queries of a rank, and those that it gets.
class BlockQueries {
public:
  /// Refers to the tree.
  explicit BlockQueries(const LatticeTree& tree) : _tree(tree) {}

  /// A query to all other ranks with blocks that touch `where`.
  void add(const GridBox& where, BlockQuery query);
  /// Sends the queries, and calls answer(queries) for those that arrive from each rank, in ascending rank.
  /// Collective.
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

/// A block that another rank owns.
struct GhostBlock {
  PackedBlock block;
  float longest_edge;  ///< see SurfaceTable

  static constexpr auto fields() { return std::tuple(&GhostBlock::block, &GhostBlock::longest_edge); }
};

/// All blocks that touch this rank's, or hold corners of its triangles. Collective.
std::vector<GhostBlock> fetch_ghosts(const Lattice& lattice);
/// Where there are far finer blocks on the surface (see looks_of_block), one of them. Collective.
std::vector<GhostBlock> fetch_finer_ghosts(const Lattice& lattice);

}  // namespace aeroloom::volume
