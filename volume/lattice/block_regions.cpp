#include "volume/lattice/block_regions.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/empty_balls.hpp"
#include "volume/lattice/region_in_block.hpp"

#include <algorithm>
#include <compare>
#include <map>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::RegionId;

namespace {

/// A face between a free block and a block that the surface meets.
struct Contact {
  BlockNumber free, met;
  BlockNumber set;     ///< of the free block, once known
  std::int64_t order;  ///< of the face, the same on any number of ranks
  Vec3 place;          ///< centre of the face, in the grid
};

/// A set of free blocks of this rank, and a block or set of another rank that touches it.
struct Joint {
  BlockNumber set, with;
  auto operator<=>(const Joint&) const = default;
};

/// Calls visit(b, n, face centre, number of the face) for the faces of this rank's blocks b that have one
/// block n on the other side.
template <class Visit>
void for_each_face(const LatticeTree& tree, const Visit& visit) {
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
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
      if (tree.cube(n).level <= cell.level) visit(b, n, place, 6 * tree.number(b) + side);
    }
  }
}

/// The sets of free blocks of this rank that are connected over faces. A set is named by the lowest number of
/// its blocks on all ranks.
class BlockSets {
public:
  BlockSets(const LatticeTree& tree, const SurfaceTable& table)
      : _tree(tree), _own(tree.last() - tree.first()), _set(tree.last() - tree.first()) {
    for_each_face(tree, [&](BlockIndex b, BlockIndex n, Vec3 place, std::int64_t face) {
      if (table.is_met(b) != table.is_met(n)) {
        const BlockIndex free = table.is_met(n) ? b : n, met = table.is_met(n) ? n : b;
        _contacts.push_back({tree.number(free), tree.number(met), 0, face, place});
      } else if (!table.is_met(b)) {
        if (tree.is_own(n))
          _own.unite(b - tree.first(), n - tree.first());
        else
          _joints.push_back({tree.number(b), tree.number(n)});
      }
    });
    for (BlockIndex i = 0; i < tree.last() - tree.first(); ++i) _set[i] = first_of(i);
  }

  /// Exchanges set numbers between ranks, and takes lower ones, until nothing changes. Collective.
  void join_over_ranks() {
    if (_tree.communicator().size() == 1) return;
    for (Joint& joint : _joints) joint.set = own_set(joint.set);
    // Afterwards both sides have each joint, as a pair of sets.
    std::vector<Joint> known = deliver(_joints);
    for (Joint& joint : known) joint = {own_set(joint.with), joint.set};
    geometry::sort_unique(known);
    for (const Joint& joint : deliver(known)) known.push_back({joint.with, joint.set});
    geometry::sort_unique(known);
    for (bool changed = true; changed;) {
      std::vector<Joint> sent;
      sent.reserve(known.size());
      for (const Joint& joint : known) sent.push_back({set(joint.set), joint.with});
      changed = false;
      for (const Joint& joint : deliver(std::move(sent))) {
        if (joint.set >= set(joint.with)) continue;
        set(joint.with) = joint.set;
        changed = true;
      }
      changed = _tree.communicator().maximum(std::int64_t{changed}) > 0;
    }
  }

  /// The set of an own block, by its number.
  BlockNumber set_of(BlockNumber b) { return set(own_set(b)); }

  /// The contacts whose block on the surface is of this rank, in the order of faces. Collective.
  std::vector<Contact> take_contacts() {
    std::vector<Contact> contacts =
        mesh::deliver(_tree.communicator(), std::move(_contacts),
                      [&](const Contact& contact) { return _tree.owner(contact.free); });
    for (Contact& contact : contacts) contact.set = set_of(contact.free);
    contacts = mesh::deliver(_tree.communicator(), std::move(contacts),
                             [&](const Contact& contact) { return _tree.owner(contact.met); });
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b) { return a.order < b.order; });
    return contacts;
  }

private:
  BlockNumber first_of(BlockIndex i) { return _tree.number(_tree.first() + _own.root(i)); }
  BlockNumber own_set(BlockNumber b) { return first_of(_tree.index(b) - _tree.first()); }
  BlockNumber& set(BlockNumber own) { return _set[_tree.index(own) - _tree.first()]; }
  std::vector<Joint> deliver(std::vector<Joint> joints) const {
    return mesh::deliver(_tree.communicator(), std::move(joints),
                         [&](const Joint& joint) { return _tree.owner(joint.with); });
  }

  const LatticeTree& _tree;
  geometry::DisjointSets<BlockIndex> _own;  // of own blocks
  std::vector<BlockNumber> _set;            // number of each own set, at its first block
  std::vector<Joint> _joints;               // with blocks of other ranks
  std::vector<Contact> _contacts;           // found by this rank
};

/// A region that was found at contacts of a set: at how many places, and the first of them.
struct Witness {
  BlockNumber set;
  RegionId region;
  std::int64_t contact;
  std::int64_t places;
  mesh::GlobalIndex triangle;
  Vec3 place;
  bool is_as(const Witness& other) const { return set == other.set && region == other.region; }
  friend bool operator<(const Witness& a, const Witness& b) {
    return std::tie(a.set, a.region, a.contact) < std::tie(b.set, b.region, b.contact);
  }
};

/// Unites the witnesses of one set and region.
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

/// Finds the region at places in blocks that the surface meets.
class RegionFinder {
public:
  RegionFinder(const Lattice& lattice, const LocalSurface& surface)
      : _lattice(lattice), _surface(surface), _in_block(lattice, surface) {}

  Vec3 place_of(const Contact& contact) const { return _lattice.frame.to_space(contact.place); }
  /// The region if an empty ball contains the place.
  std::optional<RegionId> known_region_at(Vec3 p) const { return _balls.region_at(p); }
  /// The region at a place in a block of this rank.
  std::optional<RegionInBlock::Found> find(BlockIndex b, Vec3 p) {
    if (_lattice.radii.is_region_from_block(b - _lattice.tree.first())) return _in_block.find(b, p);
    _nearest = _surface.distance().nearest(p, _nearest.triangle);
    const auto region = _surface.region_at(p, _nearest);
    if (!region) return std::nullopt;
    _balls.remember(p, _nearest.distance, *region);
    return RegionInBlock::Found{*region, _nearest.triangle};
  }

private:
  const Lattice& _lattice;
  const LocalSurface& _surface;
  RegionInBlock _in_block;
  BoundaryDistance::Nearest _nearest;
  EmptyBalls _balls;
};

/// Finds the regions at contacts. Further places of a set in an empty ball of the same region are only
/// counted.
std::vector<Witness> witnesses_of(std::span<const Contact> contacts, const LatticeTree& tree,
                                  std::span<const SurfaceTriangle> triangles, RegionFinder& finder) {
  std::vector<Witness> mine;
  std::map<std::pair<BlockNumber, RegionId>, std::size_t> known;  // of `mine`
  for (const Contact& contact : contacts) {
    const Vec3 p = finder.place_of(contact);
    if (const auto region = finder.known_region_at(p)) {
      const auto witness = known.find({contact.set, *region});
      if (witness != known.end()) {
        ++mine[witness->second].places;
        continue;
      }
    }
    const auto found = finder.find(tree.index(contact.met), p);
    if (!found) continue;
    const auto [witness, is_new] = known.insert({{contact.set, found->region}, mine.size()});
    if (is_new)
      mine.push_back({contact.set, found->region, contact.order, 1, triangles[found->triangle].number, p});
    else
      ++mine[witness->second].places;
  }
  return mine;
}

/// The contradiction of the lowest set that was found in several regions.
std::optional<Contradiction> find_contradiction(const std::vector<Witness>& witnesses) {
  const auto first = std::adjacent_find(witnesses.begin(), witnesses.end(),
                                        [](const Witness& a, const Witness& b) { return a.set == b.set; });
  if (first == witnesses.end()) return std::nullopt;
  const auto last =
      std::find_if(first, witnesses.end(), [&](const Witness& w) { return w.set != first->set; });
  const auto [fewest, most] = std::minmax_element(
      first, last, [](const Witness& a, const Witness& b) { return a.places < b.places; });
  return Contradiction{first->set, fewest->place, fewest->triangle, fewest->region, most->region};
}

/// The contradiction of the lowest set on all ranks. Collective.
std::optional<Contradiction> lowest_of(const LatticeTree& tree, const std::optional<Contradiction>& mine) {
  std::vector<Contradiction> all;
  if (mine) all.push_back(*mine);
  all = tree.communicator().all_gather_items<Contradiction>(all);
  if (all.empty()) return std::nullopt;
  return *std::min_element(all.begin(), all.end(),
                           [](const Contradiction& a, const Contradiction& b) { return a.set < b.set; });
}

/// The regions of sets, fetched from the ranks that own their lowest blocks.
class RegionsOfSets {
public:
  RegionsOfSets(const LatticeTree& tree, std::vector<BlockNumber> sets,
                const std::vector<Witness>& witnesses) {
    const parallel::Communicator& communicator = tree.communicator();
    struct SetQuery {
      BlockNumber set;
      parallel::Rank from;
      RegionId region;
    };
    geometry::sort_unique(sets);
    std::vector<SetQuery> queries;
    queries.reserve(sets.size());
    for (const BlockNumber set : sets) queries.push_back({set, communicator.rank(), mesh::no_region});
    queries =
        mesh::deliver(communicator, std::move(queries), [&](const SetQuery& a) { return tree.owner(a.set); });
    for (SetQuery& a : queries) {
      const auto seen = std::partition_point(witnesses.begin(), witnesses.end(),
                                             [&](const Witness& witness) { return witness.set < a.set; });
      if (seen != witnesses.end() && seen->set == a.set) a.region = seen->region;
    }
    for (const SetQuery& a :
         mesh::deliver(communicator, std::move(queries), [](const SetQuery& q) { return q.from; }))
      _regions[a.set] = a.region;
  }
  RegionId of(BlockNumber set) const { return _regions.at(set); }

private:
  std::map<BlockNumber, RegionId> _regions;
};

}  // namespace

BlockRegions find_block_regions(const Lattice& lattice, std::span<const SurfaceTriangle> triangles,
                                const LocalSurface& surface) {
  const LatticeTree& tree = lattice.tree;
  const SurfaceTable& table = lattice.table;
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  BlockSets sets(tree, table);
  sets.join_over_ranks();
  const std::vector<Contact> contacts = sets.take_contacts();
  RegionFinder finder(lattice, surface);
  const std::vector<Witness> witnesses =
      unite(mesh::deliver(tree.communicator(), witnesses_of(contacts, tree, triangles, finder),
                          [&](const Witness& witness) { return tree.owner(witness.set); }));
  BlockRegions found{std::vector<RegionId>(tree.last() - tree.first(), mesh::no_region),
                     lowest_of(tree, find_contradiction(witnesses))};
  std::vector<BlockNumber> of_blocks;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b)
    of_blocks.push_back(table.is_met(b) ? 0 : sets.set_of(tree.number(b)));
  const RegionsOfSets regions(tree, of_blocks, witnesses);
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    if (!table.is_met(b)) found.of_block[b - tree.first()] = regions.of(of_blocks[b - tree.first()]);
  }
  return found;
}

}  // namespace aeroloom::volume
