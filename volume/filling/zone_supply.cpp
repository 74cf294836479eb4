#include "volume/filling/zone_supply.hpp"

#include "mesh/exchange/delivery.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

struct PointOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  std::int64_t number;  ///< of the lattice
  Vec3 point;
  mesh::RegionId region;
  ZoneIndex owner;

  static constexpr auto fields() {
    return std::tuple(&PointOfZone::zone, &PointOfZone::rank, &PointOfZone::number, &PointOfZone::point,
                      &PointOfZone::region, &PointOfZone::owner);
  }
  static bool by_number(const PointOfZone& a, const PointOfZone& b) { return a.number < b.number; }
};

struct TriangleOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  SurfaceTriangle triangle;
  std::array<LeafNumber, 3> leaves;  ///< of its vertices
  std::array<ZoneIndex, 3> owners;

  static constexpr auto fields() {
    return std::tuple(&TriangleOfZone::zone, &TriangleOfZone::rank, &TriangleOfZone::triangle,
                      &TriangleOfZone::leaves, &TriangleOfZone::owners);
  }
};

struct BorderOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  std::array<std::int64_t, 3> points;  ///< of the lattice
  LeafNumber leaf;
  mesh::RegionId region;

  static constexpr auto fields() {
    return std::tuple(&BorderOfZone::zone, &BorderOfZone::rank, &BorderOfZone::points, &BorderOfZone::leaf,
                      &BorderOfZone::region);
  }
};

/// The parts of zones that travel from one rank to another.
struct Cargo {
  std::vector<PointOfZone> points, at_borders;
  std::vector<TriangleOfZone> triangles;
  std::vector<BorderOfZone> borders;
};

/// Fetches from the store what a shipment names.
class Loader {
public:
  Loader(const ZoneStore& store, const ZoneShipment& shipment) : _store(store), _shipment(shipment) {
    for (const ZoneShipment::OfBlock& want : shipment.blocks) {
      add_points(want);
      for (const BorderTriangle& t : store.borders.of(want.block)) {
        if (want.leaves >> t.child & 1) add_border(want, t);
      }
    }
    for (const ZoneShipment::Triangle& want : shipment.triangles) add_triangle(want);
  }

  Cargo cargo;

private:
  void add_points(const ZoneShipment::OfBlock& want) {
    const BlockPoints& all = _store.points;
    const std::int64_t first = all.starts[want.block - all.first];
    for (std::uint64_t left = want.points; left != 0; left &= left - 1) {
      const std::int64_t i = first + __builtin_ctzll(left);
      cargo.points.push_back({want.zone, _shipment.ranks[want.zone],
                              lattice_number(_store.lattice.tree, want.block, all.slots[i]), all.points[i],
                              all.regions[i],
                              _store.finder.zone_of({want.block, all.slots[i] / slots_per_leaf})});
    }
  }

  /// One at a zone's own point comes with all of its points, however far they are.
  void add_border(const ZoneShipment::OfBlock& want, const BorderTriangle& t) {
    const parallel::Rank rank = _shipment.ranks[want.zone];
    const mesh::RegionId region = _store.core.region(want.block);
    cargo.borders.push_back(
        {want.zone, rank, t.points, _store.lattice.tree.number(Leaf{want.block, t.child}), region});
    std::array<ZoneIndex, 3> owners;
    for (int k = 0; k < 3; ++k)
      owners[k] = _store.finder.zone_of(leaf_of_lattice(_store.lattice.tree, t.points[k]));
    if (std::find(owners.begin(), owners.end(), want.zone) == owners.end()) return;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = lattice_point(_store.lattice, leaf_of_lattice(_store.lattice.tree, t.points[k]),
                                   static_cast<int>(t.points[k] % slots_per_leaf));
      cargo.at_borders.push_back({want.zone, rank, t.points[k], p, region, owners[k]});
    }
  }

  void add_triangle(const ZoneShipment::Triangle& want) {
    TriangleOfZone sent{want.zone, _shipment.ranks[want.zone], _store.triangles[want.triangle], {}, {}};
    for (int k = 0; k < 3; ++k) {
      const Leaf leaf = _store.finder.leaf_of_place(sent.triangle.points[k]);
      sent.leaves[k] = _store.lattice.tree.number(leaf);
      sent.owners[k] = _store.finder.zone_of(leaf);
    }
    cargo.triangles.push_back(sent);
  }

  const ZoneStore& _store;
  const ZoneShipment& _shipment;
};

/// A zone's points and triangles become its problem.
class ContentBuilder {
public:
  ContentBuilder(ZoneIndex zone, const ZoneFinder& finder) : _finder(finder) {
    _content.zone = zone;
    _content.surface_vertices = finder.surface_vertices();
  }

  /// All by number.
  ZoneContent build(std::span<const PointOfZone> points, std::span<const TriangleOfZone> triangles,
                    std::span<const BorderOfZone> borders) {
    std::vector<Corner> corners;
    for (const TriangleOfZone& of_zone : triangles) {
      const SurfaceTriangle& t = of_zone.triangle;
      for (int k = 0; k < 3; ++k)
        corners.push_back(
            {t.vertices[k], t.points[k], t.dimension[k], t.entity[k], of_zone.leaves[k], of_zone.owners[k]});
    }
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.number < b.number; });
    corners.erase(std::unique(corners.begin(), corners.end(),
                              [](const Corner& a, const Corner& b) { return a.number == b.number; }),
                  corners.end());
    for (const Corner& corner : corners) {
      add_point(mesh::running_key(corner.number), corner.point, corner.leaf, corner.owner);
      _content.dimension.push_back(corner.dimension);
      _content.entity.push_back(corner.entity);
    }
    for (const TriangleOfZone& t : triangles) add_triangle(t.triangle, corners);
    for (const PointOfZone& p : points) {
      add_point(_finder.vertex_key_of(p.number), p.point, leaf_number_of_lattice(p.number), p.owner);
      _content.problem.regions.push_back(p.region);
    }
    for (const BorderOfZone& t : borders) add_border(t);
    return std::move(_content);
  }

private:
  struct Corner {
    mesh::GlobalIndex number;
    Vec3 point;
    mesh::CadDimension dimension;
    std::int32_t entity;
    LeafNumber leaf;
    ZoneIndex owner;
  };

  void add_point(mesh::SharedVertexKey vertex_key, Vec3 p, LeafNumber leaf, ZoneIndex owner) {
    _content.vertex_keys.push_back(vertex_key);
    _content.leaves.push_back(leaf);
    _content.problem.points.push_back(p);
    _content.problem.owners.push_back(owner == _content.zone  ? Owner::mine
                                      : owner < _content.zone ? Owner::lower
                                                              : Owner::higher);
  }

  /// Where all of its points are known.
  void add_border(const BorderOfZone& t) {
    const std::vector<mesh::SharedVertexKey>& vertex_keys = _content.vertex_keys;
    LocalTriangle local;
    bool is_own = false;
    int known = 0;
    for (int k = 0; k < 3; ++k) {
      const mesh::SharedVertexKey vertex_key = _finder.vertex_key_of(t.points[k]);
      const auto at = std::lower_bound(vertex_keys.begin(), vertex_keys.end(), vertex_key);
      if (at == vertex_keys.end() || *at != vertex_key) continue;
      ++known;
      local[k] = static_cast<mesh::LocalIndex>(at - vertex_keys.begin());
      is_own = is_own || _content.problem.owners[local[k]] == Owner::mine;
    }
    if (known < 3 && is_own) throw std::logic_error("a zone does not know a point of the core's border");
    if (known < 3) return;
    _content.problem.borders.push_back(local);
    _content.problem.border_regions.push_back(t.region);
    _content.border_leaves.push_back(t.leaf);
  }

  void add_triangle(const SurfaceTriangle& t, const std::vector<Corner>& corners) {
    LocalTriangle local;
    for (int k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(
          corners.begin(), corners.end(), t.vertices[k],
          [](const Corner& corner, mesh::GlobalIndex number) { return corner.number < number; });
      local[k] = static_cast<mesh::LocalIndex>(at - corners.begin());
    }
    _content.problem.triangles.push_back(local);
    _content.problem.front.push_back(t.front);
    _content.problem.back.push_back(t.back);
    _content.face.push_back(t.face);
    _content.patch.push_back(t.patch);
  }

  const ZoneFinder& _finder;
  ZoneContent _content;
};

/// Brings what zones know to their ranks, by zone. Collective.
template <class Item>
void ship(const parallel::Communicator& communicator, std::vector<Item>& items) {
  items = mesh::deliver(communicator, std::move(items), [](const Item& item) { return item.rank; });
  // Ranks have ascending blocks: what comes block by block is by number within each zone.
  const auto before = [](const Item& a, const Item& b) { return a.zone < b.zone; };
  if (!std::is_sorted(items.begin(), items.end(), before))
    std::stable_sort(items.begin(), items.end(), before);
}

/// Items of a zone, from a list by zone.
template <class Item>
std::span<Item> of_zone(std::vector<Item>& items, ZoneIndex zone) {
  const auto first =
      std::partition_point(items.begin(), items.end(), [&](const Item& item) { return item.zone < zone; });
  const auto last =
      std::partition_point(first, items.end(), [&](const Item& item) { return item.zone == zone; });
  return {first, last};
}

}  // namespace

std::vector<ZoneContent> supply_zones(const parallel::Communicator& communicator, const ZoneStore& store,
                                      const ZoneShipment& shipment) {
  Cargo cargo;
  {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    cargo = std::move(Loader(store, shipment).cargo);
  }
  ship(communicator, cargo.points);
  ship(communicator, cargo.at_borders);
  ship(communicator, cargo.triangles);
  ship(communicator, cargo.borders);
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  std::vector<ZoneContent> contents;
  for (ZoneIndex zone = 0; zone < static_cast<ZoneIndex>(shipment.ranks.size()); ++zone) {
    const std::span<PointOfZone> near = of_zone(cargo.points, zone);
    const std::span<PointOfZone> at_borders = of_zone(cargo.at_borders, zone);
    const std::span<TriangleOfZone> triangles = of_zone(cargo.triangles, zone);
    if (near.empty() && triangles.empty()) continue;
    std::sort(triangles.begin(), triangles.end(), [](const TriangleOfZone& a, const TriangleOfZone& b) {
      return a.triangle.number < b.triangle.number;
    });
    std::sort(at_borders.begin(), at_borders.end(), PointOfZone::by_number);
    const auto last =
        std::unique(at_borders.begin(), at_borders.end(),
                    [](const PointOfZone& a, const PointOfZone& b) { return a.number == b.number; });
    std::vector<PointOfZone> points;
    points.reserve(near.size());
    std::set_union(near.begin(), near.end(), at_borders.begin(), last, std::back_inserter(points),
                   PointOfZone::by_number);
    contents.push_back(
        ContentBuilder(zone, store.finder).build(points, triangles, of_zone(cargo.borders, zone)));
  }
  return contents;
}

}  // namespace aeroloom::volume
