/// What a zone knows of the space around it.
#pragma once

#include "volume/lattice_tree.hpp"
#include "volume/near_boxes.hpp"
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

/// The largest size in a block and next to it: the mean edge of the lattice, or the longest edge of the
/// surface.
double largest_size_around(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                           BlockIndex b);

/// Tells what is near a zone: nearer to its leaves than `width` times the largest size found in the block of
/// what is asked for or next to it; a size is the mean edge of the lattice or the longest edge of the
/// surface. A halo in each point's own size would fail where sizes jump.
class ZoneSurroundings {
public:
  ZoneSurroundings(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                   const Zones& zones);

  /// Which zone it is from now on.
  void move_to(ZoneIndex zone, std::span<const BlockIndex> own_blocks);
  /// Its own blocks that have neighbours of other zones.
  std::span<const BlockIndex> border() const { return _border; }
  bool is_own(BlockIndex b, int child) const { return _zones.of(b, child) == _zone; }
  bool is_all_own(BlockIndex b) const { return _zones.is_whole(b) && is_own(b, 0); }
  /// Whether a box outside of the zone is near; b is the block it lies in, or its middle.
  bool is_near(const GridBox& box, BlockIndex b, double width) {
    return _boxes.any_within(box, _frame.grid_distance(width * size_around(b)));
  }

private:
  double size_around(BlockIndex b);
  bool is_beside_others(BlockIndex b) const;

  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const SurfaceTable& _table;
  const Zones& _zones;
  ZoneIndex _zone = no_zone;
  std::vector<BlockIndex> _border;
  NearBoxes _boxes;                   // those of the border
  std::vector<float> _sizes;          // per block: largest size around, 0 where not asked for yet
  std::vector<BlockIndex> _alike_to;  // per block: up to before this one, blocks are whole and of its zone
};

/// Takes the leaves that zones know something of: their own, and those near them.
class HaloTaker {
public:
  HaloTaker(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
            const Zones& zones);

  /// By block, ascending.
  std::vector<TakenBlock> take(ZoneIndex zone, std::span<const BlockIndex> own_blocks, double width);

private:
  void look_around(BlockIndex b);
  void take_own(std::span<const BlockIndex> own_blocks);
  void judge(BlockIndex b, double width);

  const LatticeTree& _tree;
  ZoneSurroundings _surroundings;
  std::vector<std::uint8_t> _leaves;  // per block: those taken
  std::vector<std::uint8_t> _seen;    // per block
  std::vector<BlockIndex> _queue;     // blocks that were seen
};

}  // namespace aeroloom::volume
