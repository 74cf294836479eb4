/// What a zone knows of the space around it.
#pragma once

#include "volume/lattice_tree.hpp"
#include "volume/surface_share.hpp"
#include "volume/zones.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A block and those of its leaves that are taken, a bit each.
struct TakenBlock {
  BlockIndex block;
  std::uint8_t leaves;
};

/// The blocks that have leaves of each zone: zone z has those from starts[z] to starts[z + 1].
struct BlocksOfZones {
  std::vector<std::int32_t> starts;
  std::vector<BlockIndex> blocks;  ///< ascending within a zone

  std::span<const BlockIndex> of(ZoneIndex z) const {
    return std::span(blocks).subspan(starts[z], starts[z + 1] - starts[z]);
  }
};
/// All there is.
std::vector<TakenBlock> take_all(const LatticeTree& tree);
BlocksOfZones list_blocks(const LatticeTree& tree, const Zones& zones);

/// Takes what zones know: their own leaves and those nearer to one of their blocks than `width` times the largest
/// size found in that block or next to it; a size is the mean edge of the lattice or the longest edge of the
/// surface. A halo in each point's own size would fail where sizes jump.
class HaloTaker {
public:
  HaloTaker(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table, const Zones& zones);

  /// By block, ascending.
  std::vector<TakenBlock> take(ZoneIndex zone, std::span<const BlockIndex> own_blocks, double width);

private:
  double size_of(BlockIndex b) const;
  void add(BlockIndex b, std::uint8_t leaves);

  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const SurfaceTable& _table;
  const Zones& _zones;
  std::vector<std::uint8_t> _leaves;  // per block
  std::vector<BlockIndex> _touched;
};

}  // namespace aeroloom::volume
