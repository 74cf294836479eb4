#include "volume/block_regions.hpp"

#include "geometry/disjoint_sets.hpp"
#include "mesh/delivery.hpp"
#include "volume/empty_balls.hpp"
#include "volume/within_blocks.hpp"

#include <algorithm>
#include <compare>
#include <map>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::RegionId;

namespace {

/// The rank that has a block.
parallel::Rank owner_of(std::span<const BlockIndex> shares, BlockIndex b) {
  return static_cast<parallel::Rank>(std::upper_bound(shares.begin(), shares.end() - 1, b) - shares.begin() -
                                     1);
}

/// A face between a block that the surface does not meet and one that it does.
struct Contact {
  BlockIndex free, met;
  BlockIndex set;      ///< that the free block is in, where known
  std::int64_t order;  ///< of faces, the same on any number of ranks
  Vec3 place;          ///< in the grid

  static constexpr auto fields() {
    return std::tuple(&Contact::free, &Contact::met, &Contact::set, &Contact::order, &Contact::place);
  }
};

/// A set of blocks of one rank that has a face in common with a block, or a set, of another.
struct Joint {
  BlockIndex set, with;

  static constexpr auto fields() { return std::tuple(&Joint::set, &Joint::with); }
  auto operator<=>(const Joint&) const = default;
};

/// Calls visit(b, n, face centre, number of the face) for the faces of the blocks b from first to last whose
/// other side is one block n.
template <class Visit>
void for_each_face(const LatticeTree& tree, BlockIndex first, BlockIndex last, const Visit& visit) {
  for (BlockIndex b = first; b < last; ++b) {
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
      if (tree.cube(n).level <= cell.level) visit(b, n, place, 6 * std::int64_t{b} + side);
    }
  }
}

/// The sets of blocks that are joined over faces, as far as this rank's blocks are concerned; the lowest
/// block of a set stands for it.
class BlockSets {
public:
  BlockSets(const LatticeTree& tree, const SurfaceTable& table, BlockIndex first, BlockIndex last)
      : _first(first), _last(last), _own(last - first) {
    for_each_face(tree, first, last, [&](BlockIndex b, BlockIndex n, Vec3 place, std::int64_t face) {
      if (table.is_met(b) != table.is_met(n)) {
        const BlockIndex free = table.is_met(n) ? b : n, met = table.is_met(n) ? n : b;
        _contacts.push_back({free, met, 0, face, place});
      } else if (!table.is_met(b)) {
        if (is_own(n))
          _own.unite(b - first, n - first);
        else
          _joints.push_back({b, n});
      }
    });
  }

  /// Collective.
  void join_those_of_all_ranks(const parallel::Communicator& communicator,
                               std::span<const BlockIndex> shares) {
    for (Joint& joint : _joints) joint.set = own_set(joint.set);
    keep_each_once(_joints);
    _joints = mesh::deliver(communicator, std::move(_joints),
                            [&](const Joint& joint) { return owner_of(shares, joint.with); });
    for (Joint& joint : _joints) joint.with = own_set(joint.with);
    keep_each_once(_joints);
    const std::vector<Joint> all = communicator.all_gather_items<Joint>(_joints);
    std::vector<BlockIndex> sets;
    for (const Joint& joint : all) sets.insert(sets.end(), {joint.set, joint.with});
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    const auto place_of = [&](BlockIndex set) {
      return static_cast<BlockIndex>(std::lower_bound(sets.begin(), sets.end(), set) - sets.begin());
    };
    geometry::DisjointSets<BlockIndex> joined(sets.size());
    for (const Joint& joint : all) joined.unite(place_of(joint.set), place_of(joint.with));
    for (std::size_t i = 0; i < sets.size(); ++i) _joined[sets[i]] = sets[joined.root(static_cast<int>(i))];
  }

  /// Of a block of this rank.
  BlockIndex set_of(BlockIndex b) {
    const BlockIndex set = own_set(b);
    const auto joined = _joined.find(set);
    return joined == _joined.end() ? set : joined->second;
  }

  /// The contacts of this rank's met blocks in the order of faces, each with its set. Collective.
  std::vector<Contact> take_contacts(const parallel::Communicator& communicator,
                                     std::span<const BlockIndex> shares) {
    std::vector<Contact> contacts =
        mesh::deliver(communicator, std::move(_contacts),
                      [&](const Contact& contact) { return owner_of(shares, contact.free); });
    for (Contact& contact : contacts) contact.set = set_of(contact.free);
    contacts = mesh::deliver(communicator, std::move(contacts),
                             [&](const Contact& contact) { return owner_of(shares, contact.met); });
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b) { return a.order < b.order; });
    return contacts;
  }

private:
  bool is_own(BlockIndex b) const { return b >= _first && b < _last; }
  BlockIndex own_set(BlockIndex b) { return _first + _own.root(b - _first); }
  static void keep_each_once(std::vector<Joint>& joints) {
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  }

  BlockIndex _first, _last;
  geometry::DisjointSets<BlockIndex> _own;   // of this rank's blocks, from the first on
  std::vector<Joint> _joints;                // at first of blocks, then of sets
  std::vector<Contact> _contacts;            // that this rank has met
  std::map<BlockIndex, BlockIndex> _joined;  // sets that are parts of larger ones
};

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

/// What is seen from contacts, of which the blocks from first on are the met ones. The first place of each
/// kind is looked at for what it tells; others in an empty ball, whose region is known, only count.
std::vector<Witness> witnesses_of(std::span<const Contact> contacts, BlockIndex first,
                                  std::span<const SurfaceTriangle> triangles, Look& look) {
  std::vector<Witness> mine;
  std::map<std::pair<BlockIndex, RegionId>, std::size_t> known;  // of `mine`
  for (const Contact& contact : contacts) {
    const Vec3 p = look.place_of(contact);
    if (const auto region = look.known_region_at(p)) {
      const auto witness = known.find({contact.set, *region});
      if (witness != known.end()) {
        ++mine[witness->second].places;
        continue;
      }
    }
    const auto seen = look.from(contact.met, contact.met - first, p);
    if (!seen) continue;
    const auto [witness, is_new] = known.insert({{contact.set, seen->region}, mine.size()});
    if (is_new)
      mine.push_back({contact.set, seen->region, contact.order, 1, triangles[seen->triangle].number, p});
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
  const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
  const BlockIndex first = shares[communicator.rank()], last = shares[communicator.rank() + 1];
  BlockSets sets(tree, table, first, last);
  sets.join_those_of_all_ranks(communicator, shares);
  const std::vector<Contact> contacts = sets.take_contacts(communicator, shares);
  Look look(frame, tree, table, surface, reach);
  const std::vector<Witness> mine = witnesses_of(contacts, first, triangles, look);
  const std::vector<Witness> witnesses = unite(communicator.all_gather_items<Witness>(mine));
  BlockRegions found{std::vector<RegionId>(tree.block_count(), mesh::no_region),
                     find_contradiction(witnesses)};
  for (BlockIndex b = first; b < last; ++b) {
    if (table.is_met(b)) continue;
    const BlockIndex set = sets.set_of(b);
    const auto seen = std::partition_point(witnesses.begin(), witnesses.end(),
                                           [set](const Witness& witness) { return witness.set < set; });
    if (seen != witnesses.end() && seen->set == set) found.of_block[b] = seen->region;
  }
  return found;
}

}  // namespace aeroloom::volume
