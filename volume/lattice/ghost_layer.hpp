/// The ghost layer: the blocks of other ranks that touch blocks of this rank, and their values.
#pragma once

#include "mesh/exchange/delivery.hpp"
#include "volume/lattice/lattice_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace aeroloom::volume {

/// Gives each own block and each ghost a *place* in arrays: own blocks first, then ghosts, both ascending.
class GhostLayer {
public:
  /// Collective.
  explicit GhostLayer(const LatticeTree& tree);

  std::size_t own_count() const { return static_cast<std::size_t>(_last - _first); }
  std::size_t count() const { return own_count() + _ghosts.size(); }
  bool is_own(BlockIndex b) const { return b >= _first && b < _last; }
  BlockIndex first() const { return _first; }
  BlockIndex ghost(std::size_t i) const { return _ghosts[i]; }
  /// The place of an own block or of a ghost.
  std::size_t place(BlockIndex b) const {
    if (is_own(b)) return static_cast<std::size_t>(b - _first);
    const auto at = std::lower_bound(_ghosts.begin(), _ghosts.end(), b);
    return own_count() + static_cast<std::size_t>(at - _ghosts.begin());
  }

  /// Updates the values of ghosts from their owners. `values` has one per place. Collective.
  template <parallel::Flat T>
  void update(std::vector<T>& values) const {
    if (_communicator.size() == 1) return;
    struct Parcel {
      T value;
      Wanted wanted;
    };
    std::vector<Parcel> parcels;
    parcels.reserve(_wanted.size());
    for (const Wanted& wanted : _wanted) parcels.push_back({values[wanted.block], wanted});
    for (const Parcel& parcel :
         mesh::deliver(_communicator, std::move(parcels), [](const Parcel& p) { return p.wanted.rank; }))
      values[parcel.wanted.place] = parcel.value;
  }

private:
  /// A block of this rank that is a ghost on another rank, and its place there.
  struct Wanted {
    BlockNumber block;  ///< its number; at its owner, its place there
    std::int32_t place;
    parallel::Rank rank;
  };

  parallel::Communicator _communicator;
  BlockIndex _first, _last;
  std::vector<BlockIndex> _ghosts;  // ascending
  std::vector<Wanted> _wanted;
};

}  // namespace aeroloom::volume
