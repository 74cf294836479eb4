#include "volume/block_regions.hpp"

#include "geometry/disjoint_sets.hpp"
#include "volume/empty_balls.hpp"
#include "volume/within_blocks.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::RegionId;

namespace {

/// Sets of blocks that are joined over faces.
using BlockSets = geometry::DisjointSets<BlockIndex>;

/// A face between a block that the surface does not meet and one that it does.
struct Contact {
  BlockIndex free, met;
  Vec3 place;  ///< in the grid
};

/// Calls visit(b, n, face centre) for the faces of each block b whose other side is one block n.
template <class Visit>
void for_each_face(const LatticeTree& tree, const Visit& visit) {
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    const GridCube cell = tree.cube(b);
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
      if (tree.cube(n).level <= cell.level) visit(b, n, place);
    }
  }
}

/// What was seen of a set of blocks, from how many places, and the first of them.
struct Witness {
  BlockIndex set;
  RegionId region;
  std::int64_t contact;
  std::int64_t places;
  mesh::GlobalIndex triangle;
  Vec3 place;

  static constexpr auto fields() {
    return std::tuple(&Witness::set, &Witness::region, &Witness::contact, &Witness::places,
                      &Witness::triangle, &Witness::place);
  }
  bool is_as(const Witness& other) const { return set == other.set && region == other.region; }
  friend bool operator<(const Witness& a, const Witness& b) {
    return std::tie(a.set, a.region, a.contact) < std::tie(b.set, b.region, b.contact);
  }
};

/// One per set and region.
std::vector<Witness> unite(std::vector<Witness> all) {
  std::sort(all.begin(), all.end());
  std::vector<Witness> united;
  for (const Witness& seen : all) {
    if (!united.empty() && united.back().is_as(seen))
      united.back().places += seen.places;
    else
      united.push_back(seen);
  }
  return united;
}

/// Looks for the region of places in blocks that the surface meets.
class Look {
public:
  Look(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
       const NearSurface& surface, const SurfaceReach& reach)
      : _frame(frame), _surface(surface), _reach(reach), _within(frame, tree, table, surface) {}

  Vec3 place_of(const Contact& contact) const { return _frame.to_space(contact.place); }
  /// Where an empty ball tells it.
  std::optional<RegionId> known_region_at(Vec3 p) const { return _balls.region_at(p); }
  /// From a place in a block, which has this place in the rank's share.
  std::optional<WithinBlocks::Seen> from(BlockIndex b, std::size_t in_share, Vec3 p) {
    if (_reach.is_from_within(in_share)) return _within.look(b, p);
    _nearest = _surface.distance().nearest(p, _nearest.triangle);
    const auto region = _surface.region_at(p, _nearest);
    if (!region) return std::nullopt;
    _balls.remember(p, _nearest.distance, *region);
    return WithinBlocks::Seen{*region, _nearest.triangle};
  }

private:
  const LatticeFrame& _frame;
  const NearSurface& _surface;
  const SurfaceReach& _reach;
  WithinBlocks _within;
  BoundaryDistance::Nearest _nearest;
  EmptyBalls _balls;
};

/// What is seen from the contacts of which blocks first to last are the met ones. The first place of each
/// kind is looked at for what it tells; others in an empty ball, whose region is known, only count.
std::vector<Witness> witnesses_of(std::span<const Contact> contacts, BlockIndex first, BlockIndex last,
                                  BlockSets& sets, std::span<const SurfaceTriangle> triangles, Look& look) {
  std::vector<Witness> mine;
  std::map<std::pair<BlockIndex, RegionId>, std::size_t> known;  // of `mine`
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (contact.met < first || contact.met >= last) continue;
    const Vec3 p = look.place_of(contact);
    const BlockIndex set = sets.root(contact.free);
    if (const auto region = look.known_region_at(p)) {
      const auto witness = known.find({set, *region});
      if (witness != known.end()) {
        ++mine[witness->second].places;
        continue;
      }
    }
    const auto seen = look.from(contact.met, contact.met - first, p);
    if (!seen) continue;
    const auto [witness, is_new] = known.insert({{set, seen->region}, mine.size()});
    if (is_new)
      mine.push_back(
          {set, seen->region, static_cast<std::int64_t>(i), 1, triangles[seen->triangle].number, p});
    else
      ++mine[witness->second].places;
  }
  return mine;
}

/// The witnesses of the lowest set that is seen in several regions: what fewest places and what most say.
std::optional<Contradiction> find_contradiction(const std::vector<Witness>& witnesses) {
  const auto first = std::adjacent_find(witnesses.begin(), witnesses.end(),
                                        [](const Witness& a, const Witness& b) { return a.set == b.set; });
  if (first == witnesses.end()) return std::nullopt;
  const auto last =
      std::find_if(first, witnesses.end(), [&](const Witness& w) { return w.set != first->set; });
  const auto [fewest, most] = std::minmax_element(
      first, last, [](const Witness& a, const Witness& b) { return a.places < b.places; });
  return Contradiction{fewest->place, fewest->triangle, fewest->region, most->region};
}

}  // namespace

BlockRegions find_block_regions(const parallel::Communicator& communicator, const LatticeFrame& frame,
                                const LatticeTree& tree, const SurfaceTable& table,
                                std::span<const BlockIndex> shares,
                                std::span<const SurfaceTriangle> triangles, const NearSurface& surface,
                                const SurfaceReach& reach, parallel::StageClock& clock) {
  const BlockIndex count = tree.block_count();
  BlockSets sets(count);
  std::vector<Contact> contacts;
  {
    const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
    for_each_face(tree, [&](BlockIndex b, BlockIndex n, Vec3 place) {
      if (!table.is_met(b) && !table.is_met(n))
        sets.unite(b, n);
      else if (table.is_met(b) != table.is_met(n))
        contacts.push_back(table.is_met(n) ? Contact{b, n, place} : Contact{n, b, place});
    });
  }
  std::vector<Witness> mine;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    const BlockIndex first = shares[communicator.rank()], last = shares[communicator.rank() + 1];
    Look look(frame, tree, table, surface, reach);
    mine = witnesses_of(contacts, first, last, sets, triangles, look);
  }
  const std::vector<Witness> witnesses = unite(communicator.all_gather_items<Witness>(mine));
  BlockRegions found{std::vector<RegionId>(count, mesh::no_region), find_contradiction(witnesses)};
  std::vector<RegionId> of_set(count, mesh::no_region);
  for (const Witness& seen : witnesses) of_set[seen.set] = seen.region;
  for (BlockIndex b = 0; b < count; ++b) {
    if (!table.is_met(b)) found.of_block[b] = of_set[sets.root(b)];
  }
  return found;
}

}  // namespace aeroloom::volume
