/// The blocks of other ranks that touch this rank's, and what their owners know of them.
#pragma once

#include "mesh/exchange/delivery.hpp"
#include "volume/lattice/lattice_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// Values per block, own ones and ghosts, by *place*: own blocks first, along the curve, then the ghosts.
class GhostBlocks {
public:
  /// Collective.
  explicit GhostBlocks(const LatticeTree& tree);

  std::size_t own_count() const { return static_cast<std::size_t>(_last - _first); }
  std::size_t count() const { return own_count() + _ghosts.size(); }
  bool is_own(BlockIndex b) const { return b >= _first && b < _last; }
  BlockIndex first() const { return _first; }
  BlockIndex ghost(std::size_t i) const { return _ghosts[i]; }
  /// Of an own block, or one that touches one.
  std::size_t place(BlockIndex b) const {
    if (is_own(b)) return static_cast<std::size_t>(b - _first);
    const auto at = std::lower_bound(_ghosts.begin(), _ghosts.end(), b);
    return own_count() + static_cast<std::size_t>(at - _ghosts.begin());
  }

  /// Brings the values of the ghosts from their owners. Collective.
  template <parallel::Flat T>
  void update(std::vector<T>& values) const {
    if (_communicator.size() == 1) return;
    struct Parcel {
      T value;
      Wanted wanted;
      static constexpr auto fields() { return std::tuple(&Parcel::value, &Parcel::wanted); }
    };
    std::vector<Parcel> parcels;
    parcels.reserve(_wanted.size());
    for (const Wanted& wanted : _wanted) parcels.push_back({values[wanted.block], wanted});
    for (const Parcel& parcel :
         mesh::deliver(_communicator, std::move(parcels), [](const Parcel& p) { return p.wanted.rank; }))
      values[parcel.wanted.place] = parcel.value;
  }

private:
  /// A block of this rank that another one has as a ghost, and where it keeps it.
  struct Wanted {
    BlockNumber block;  ///< its place with its owner, once it has arrived there
    std::int32_t place;
    parallel::Rank rank;
    static constexpr auto fields() { return std::tuple(&Wanted::block, &Wanted::place, &Wanted::rank); }
  };

  parallel::Communicator _communicator;
  BlockIndex _first, _last;
  std::vector<BlockIndex> _ghosts;  // ascending
  std::vector<Wanted> _wanted;
};

}  // namespace aeroloom::volume
