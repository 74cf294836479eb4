/// Fetches ghosts, blocks of other ranks, by queries to their owners.
#pragma once

#include "volume/lattice/fetch_ghosts.hpp"
#include "volume/lattice/grid_box_tree.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// Sends the queries and returns the blocks that other ranks send back. The function
/// add_blocks(queries, add) gets the queries of one rank. It calls add(b) for each block b that goes there.
/// Collective.
template <class AddBlocks>
std::vector<GhostBlock> fetch_blocks(const Lattice& lattice, BlockQueries& queries,
                                     const AddBlocks& add_blocks) {
  struct Parcel {
    GhostBlock block;
    parallel::Rank to;
  };
  std::vector<Parcel> parcels;
  queries.exchange([&](std::span<const BlockQuery> of_rank) {
    add_blocks(of_rank, [&](BlockIndex b) {
      parcels.push_back({{lattice.tree.packed(b), lattice.table.longest_edge[b]}, of_rank.front().from});
    });
  });
  std::vector<GhostBlock> fetched;
  for (const Parcel& parcel :
       mesh::deliver(lattice.tree.communicator(), std::move(parcels), [](const Parcel& p) { return p.to; }))
    fetched.push_back(parcel.block);
  return fetched;
}

/// Calls add(b) for this rank's blocks with is_wanted(cube of b). is_wanted must also hold for all cubes that
/// contain such a block.
template <class IsWanted, class Add>
void add_own_blocks(const LatticeTree& tree, const IsWanted& is_wanted, const Add& add) {
  const auto add_if_wanted = [&](BlockIndex b) {
    if (is_wanted(tree.cube(b))) add(b);
    return false;
  };
  tree.any_block_in(GridBox::of(GridCube{}), add_if_wanted,
                    [&](BlockIndex first, BlockIndex last, const GridCube& cube) {
                      return last <= tree.first() || first >= tree.last() || !is_wanted(cube);
                    });
}

/// The boxes of queries, by the level of the block that they are for.
class BoxesByLevel {
public:
  explicit BoxesByLevel(std::span<const BlockQuery> queries) {
    for (const BlockQuery& query : queries) _of_level[query.level].add(query.box);
    for (GridBoxTree& boxes : _of_level) boxes.build();
  }
  /// Whether a box of this level or a finer one touches `box`.
  bool any_from(int level, const GridBox& box) const {
    for (std::size_t l = std::max(level, 0); l < _of_level.size(); ++l) {
      if (_of_level[l].any_within(box, 0)) return true;
    }
    return false;
  }

private:
  std::array<GridBoxTree, sizing::finest_level + 1> _of_level;
};

}  // namespace aeroloom::volume
