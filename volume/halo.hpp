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

/// The largest size in a block and next to it: the mean edge of the lattice, or the longest edge of the
/// surface.
double largest_size_around(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                           BlockIndex b);

/// A tree over boxes of the grid that tells whether one is near.
class NearBoxes {
public:
  void clear() { _boxes.clear(), _nodes.clear(); }
  /// Boxes that are near each other should follow each other.
  void add(const GridBox& box) { _boxes.push_back(box); }
  void build();
  /// Whether a box is at most `reach` away.
  bool any_within(const GridBox& box, double reach) const {
    return !_boxes.empty() && any_below(0, 0, _boxes.size(), box, reach);
  }

private:
  GridBox build(std::size_t node, std::size_t first, std::size_t last);
  bool any_below(std::size_t node, std::size_t first, std::size_t last, const GridBox& box,
                 double reach) const;

  std::vector<GridBox> _boxes;
  std::vector<GridBox> _nodes;  // children of node n: 2 n + 1, 2 n + 2
};

/// Takes what zones know: their own leaves, and those nearer to them than `width` times the largest size
/// found in the leaf's block or next to it; a size is the mean edge of the lattice or the longest edge of the
/// surface. A halo in each point's own size would fail where sizes jump.
class HaloTaker {
public:
  HaloTaker(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
            const Zones& zones);

  /// By block, ascending.
  std::vector<TakenBlock> take(ZoneIndex zone, std::span<const BlockIndex> own_blocks, double width);

private:
  bool is_own(BlockIndex b, int child) const { return _zones.of(b, child) == _zone; }
  bool is_all_own(BlockIndex b) const { return _zones.is_whole(b) && is_own(b, 0); }
  double size_around(BlockIndex b);
  bool look_around(BlockIndex b);
  void list_border(std::span<const BlockIndex> own_blocks);
  void judge(BlockIndex b, double width);

  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const SurfaceTable& _table;
  const Zones& _zones;
  ZoneIndex _zone = no_zone;
  std::vector<std::uint8_t> _leaves;  // per block: those taken
  std::vector<std::uint8_t> _seen;    // per block
  std::vector<float> _sizes;          // per block: largest size around, 0 where not asked for yet
  std::vector<BlockIndex> _queue;     // blocks that were seen
  NearBoxes _border;                  // own blocks that have neighbours of other zones
};

}  // namespace aeroloom::volume
