/// The p4est forest behind a Forest. It has one tree, or 4 x 4 x 4 trees. Many trees allow two more levels,
/// but balancing costs several times as much. Internal to the namespace forest.
#pragma once

#include "volume/lattice/forest.hpp"

#include <cstdint>
#include <memory>
#include <span>

#include <p8est.h>

namespace aeroloom::forest {

/// The level of the cubes that are trees. Many trees follow the Morton curve, eight in a cube of level 1, so
/// leaves in p4est's order follow it too.
inline constexpr int one_tree = 0, many_trees = 2;
inline constexpr int tree_count = 1 << 3 * many_trees;

/// One bit per tree.
using TreeSet = std::uint64_t;
inline bool has(TreeSet set, int tree) {
  return (set >> tree & 1) != 0;
}

/// Use it only while a LibraryScope lives.
class Brick {
public:
  /// Each tree is one leaf. Collective.
  Brick(const parallel::Communicator& communicator, int tree_level);
  /// The leaves of a forest; a leaf larger than a tree becomes the trees in it. Each leaf of this rank has
  /// its weight in p.user_int. Collective.
  Brick(const Forest& forest, std::span<const std::int32_t> weights);

  const parallel::Communicator& communicator() const { return _communicator; }
  p8est_t& forest() { return *_forest; }
  int tree_level() const { return _tree_level; }
  /// The finest level that leaves can have.
  int finest() const { return _tree_level + P8EST_QMAXLEVEL; }
  /// The trees with more than one leaf. Collective.
  TreeSet split_trees() const;
  /// Sets the trees that are part of a leaf of another tree. The default is none, or those of the forest that
  /// this was made from.
  void unite(TreeSet within) { _within = within; }
  /// The level of the leaf that begins at an unsplit tree.
  int level_at(int tree) const;
  /// The leaves as a Forest. Collective.
  Forest take() const;

  /// Calls visit(tree, octant) for the leaves of this rank, in Morton order.
  template <class Visit>
  void for_each_octant(const Visit& visit) const {
    for (int t = _forest->first_local_tree; t <= _forest->last_local_tree; ++t) {
      sc_array_t& octants = p8est_tree_array_index(_forest->trees, t)->quadrants;
      for (std::size_t i = 0; i < octants.elem_count; ++i) visit(t, *p8est_quadrant_array_index(&octants, i));
    }
  }

  std::uint64_t key_of(int tree) const {
    return static_cast<std::uint64_t>(tree) << 3 * (geometry::finest_level - _tree_level);
  }
  std::uint64_t key_of(int tree, const p8est_quadrant_t& octant) const;
  geometry::GridCube cube_of(int tree, const p8est_quadrant_t& octant) const {
    return {geometry::grid_point(key_of(tree, octant)), octant.level + _tree_level};
  }

private:
  struct Free {
    void operator()(p8est_connectivity_t* brick) const { p8est_connectivity_destroy(brick); }
    void operator()(p8est_t* forest) const { p8est_destroy(forest); }
  };
  parallel::Communicator _communicator;
  int _tree_level;
  TreeSet _within = 0;
  std::unique_ptr<p8est_connectivity_t, Free> _connectivity;
  std::unique_ptr<p8est_t, Free> _forest;
};

}  // namespace aeroloom::forest
