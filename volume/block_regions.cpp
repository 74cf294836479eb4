#include "volume/block_regions.hpp"

#include "parallel/collective_error.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::RegionId;

namespace {

/// Sets of blocks that are joined over faces.
class BlockSets {
public:
  explicit BlockSets(BlockIndex count) : _parent(count) { std::iota(_parent.begin(), _parent.end(), 0); }
  BlockIndex root(BlockIndex b) {
    while (_parent[b] != b) b = _parent[b] = _parent[_parent[b]];
    return b;
  }
  void join(BlockIndex a, BlockIndex b) {
    a = root(a), b = root(b);
    _parent[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<BlockIndex> _parent;
};

/// A face between a block that the surface does not meet and one that it does.
struct Contact {
  BlockIndex free, met;
  Vec3 place;  ///< in the grid
};

/// Calls visit(b, n, face centre) for the faces of each block b whose other side is one block n.
template <class Visit>
void for_each_face(const LatticeTree& tree, const Visit& visit) {
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    const GridCell cell = tree.cell(b);
    const std::uint32_t edge = cell.edge();
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const bool high = side % 2;
      std::uint32_t low[3] = {cell.low.x, cell.low.y, cell.low.z};
      if (high ? low[axis] + edge >= sizing::grid_size : low[axis] == 0) continue;
      Vec3 place{low[0] + 0.5 * edge, low[1] + 0.5 * edge, low[2] + 0.5 * edge};
      place[axis] += high ? 0.5 * edge : -0.5 * edge;
      low[axis] = high ? low[axis] + edge : low[axis] - 1;
      const BlockIndex n = tree.block_at({low[0], low[1], low[2]});
      if (tree.cell(n).level <= cell.level) visit(b, n, place);
    }
  }
}

/// What was seen of a set of blocks at one place or several.
struct Witness {
  BlockIndex set;
  RegionId region;
  friend auto operator<=>(const Witness&, const Witness&) = default;
};

}  // namespace

std::vector<RegionId> find_block_regions(const parallel::Communicator& communicator,
                                         const LatticeFrame& frame, const LatticeTree& tree,
                                         const SurfaceTable& table, std::span<const BlockIndex> shares,
                                         const NearSurface& surface, parallel::StageClock& clock) {
  const BlockIndex count = tree.block_count();
  BlockSets sets(count);
  std::vector<Contact> contacts;
  std::vector<Witness> mine;
  {
    const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
    for_each_face(tree, [&](BlockIndex b, BlockIndex n, Vec3 place) {
      if (!table.is_met(b) && !table.is_met(n))
        sets.join(b, n);
      else if (table.is_met(b) != table.is_met(n))
        contacts.push_back(table.is_met(n) ? Contact{b, n, place} : Contact{n, b, place});
    });
  }
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    const BlockIndex first = shares[communicator.rank()], last = shares[communicator.rank() + 1];
    for (const Contact& contact : contacts) {
      if (contact.met < first || contact.met >= last) continue;
      const Vec3 p = frame.to_space(contact.place);
      const auto region = surface.region_at(p, surface.distance().nearest(p));
      if (region) mine.push_back({sets.root(contact.free), *region});
    }
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  }
  std::vector<RegionId> of_set(count, mesh::no_region);
  std::vector<std::int8_t> known(count, 0);
  for (const Witness& seen : communicator.all_gather_items<Witness>(mine)) {
    if (known[seen.set] && of_set[seen.set] != seen.region) {
      const Vec3 p = frame.to_space(GridBox::of(tree.cell(seen.set)).low);
      throw parallel::CollectiveError(
          parallel::FailureKind::input,
          fmt::format(
              "the surface has a gap: the space around ({:.6g}, {:.6g}, {:.6g}) lies in different regions "
              "seen from different sides. Repair the geometry, or use smaller elements there",
              p.x, p.y, p.z));
    }
    of_set[seen.set] = seen.region;
    known[seen.set] = 1;
  }
  std::vector<RegionId> regions(count, mesh::no_region);
  for (BlockIndex b = 0; b < count; ++b) {
    if (!table.is_met(b)) regions[b] = of_set[sets.root(b)];
  }
  return regions;
}

}  // namespace aeroloom::volume
