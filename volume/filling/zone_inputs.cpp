#include "volume/filling/zone_inputs.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
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
  static bool by_number(const PointOfZone& a, const PointOfZone& b) { return a.number < b.number; }
};

struct TriangleOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  SurfaceTriangle triangle;
  std::array<LeafNumber, 3> leaves;  ///< of its vertices
  std::array<ZoneIndex, 3> owners;
};

struct BorderOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  std::array<std::int64_t, 3> points;  ///< of the lattice
  LeafNumber leaf;
  mesh::RegionId region;
};

/// The parts of zone inputs that one rank sends to others.
struct ZoneItems {
  std::vector<PointOfZone> points, at_borders;
  std::vector<TriangleOfZone> triangles;
  std::vector<BorderOfZone> borders;
};

/// Collects what this rank sends.
class ItemCollector {
public:
  ItemCollector(const Lattice& lattice, const Shell& shell, const SendPlan& plan)
      : _lattice(lattice), _shell(shell), _plan(plan) {
    for (const SendPlan::OfBlock& want : plan.blocks) {
      add_points(want);
      for (const BorderTriangle& t : shell.local.borders.of(want.block)) {
        if (want.leaves >> t.child & 1) add_border(want, t);
      }
    }
    for (const SendPlan::Triangle& want : plan.triangles) add_triangle(want);
  }

  ZoneItems sent;

private:
  void add_points(const SendPlan::OfBlock& want) {
    const BlockPoints& all = _shell.local.points;
    const std::int64_t first = all.starts[want.block - all.first];
    for (std::uint64_t left = want.points; left != 0; left &= left - 1) {
      const std::int64_t i = first + __builtin_ctzll(left);
      sent.points.push_back({want.zone, _plan.ranks[want.zone],
                             lattice_number(_lattice.tree, want.block, all.slots[i]), all.points[i],
                             all.regions[i], _shell.zones.of(want.block, all.slots[i] / slots_per_leaf)});
    }
  }

  /// A border triangle with a point of the zone is sent with all three points, however far they are.
  void add_border(const SendPlan::OfBlock& want, const BorderTriangle& t) {
    const parallel::Rank rank = _plan.ranks[want.zone];
    const mesh::RegionId region = _shell.local.core.region(want.block);
    sent.borders.push_back(
        {want.zone, rank, t.points, _lattice.tree.number(Leaf{want.block, t.child}), region});
    std::array<ZoneIndex, 3> owners;
    for (int k = 0; k < 3; ++k) owners[k] = _shell.zones.of(leaf_of_lattice(_lattice.tree, t.points[k]));
    if (std::find(owners.begin(), owners.end(), want.zone) == owners.end()) return;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = lattice_point(_lattice, _shell.local.changes, t.points[k]);
      sent.at_borders.push_back({want.zone, rank, t.points[k], p, region, owners[k]});
    }
  }

  void add_triangle(const SendPlan::Triangle& want) {
    TriangleOfZone item{want.zone, _plan.ranks[want.zone], _lattice.triangles[want.triangle], {}, {}};
    for (int k = 0; k < 3; ++k) {
      const Leaf leaf = _lattice.leaf_at(item.triangle.points[k]);
      item.leaves[k] = _lattice.tree.number(leaf);
      item.owners[k] = _shell.zones.of(leaf);
    }
    sent.triangles.push_back(item);
  }

  const Lattice& _lattice;
  const Shell& _shell;
  const SendPlan& _plan;
};

/// Makes the input of a zone from its points and triangles.
class InputBuilder {
public:
  InputBuilder(ZoneIndex zone, const Lattice& lattice) : _lattice(lattice) {
    _input.zone = zone;
    _input.surface_vertices = lattice.surface_vertices;
  }

  /// Points and triangles must be sorted by number.
  ZoneInput build(std::span<const PointOfZone> points, std::span<const TriangleOfZone> triangles,
                  std::span<const BorderOfZone> borders) {
    std::vector<Corner> corners;
    for (const TriangleOfZone& of_zone : triangles) {
      const SurfaceTriangle& t = of_zone.triangle;
      for (int k = 0; k < 3; ++k)
        corners.push_back(
            {t.vertices[k], t.points[k], t.dimension[k], t.entity[k], of_zone.leaves[k], of_zone.owners[k]});
    }
    geometry::sort_unique(
        corners, [](const Corner& a, const Corner& b) { return a.number < b.number; },
        [](const Corner& a, const Corner& b) { return a.number == b.number; });
    for (const Corner& corner : corners) {
      add_point(mesh::running_key(corner.number), corner.point, corner.leaf, corner.owner);
      _input.dimension.push_back(corner.dimension);
      _input.entity.push_back(corner.entity);
    }
    for (const TriangleOfZone& t : triangles) add_triangle(t.triangle, corners);
    for (const PointOfZone& p : points) {
      add_point(_lattice.vertex_key(p.number), p.point, leaf_number_of_lattice(p.number), p.owner);
      _input.problem.regions.push_back(p.region);
    }
    for (const BorderOfZone& t : borders) add_border(t);
    return std::move(_input);
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
    _input.vertex_keys.push_back(vertex_key);
    _input.leaves.push_back(leaf);
    _input.problem.points.push_back(p);
    _input.problem.owners.push_back(owner == _input.zone  ? Owner::mine
                                    : owner < _input.zone ? Owner::lower
                                                          : Owner::higher);
  }

  /// Adds a border triangle if the zone has all its points.
  void add_border(const BorderOfZone& t) {
    const std::vector<mesh::SharedVertexKey>& vertex_keys = _input.vertex_keys;
    LocalTriangle local;
    bool is_own = false;
    int known = 0;
    for (int k = 0; k < 3; ++k) {
      const mesh::SharedVertexKey vertex_key = _lattice.vertex_key(t.points[k]);
      const auto at = std::lower_bound(vertex_keys.begin(), vertex_keys.end(), vertex_key);
      if (at == vertex_keys.end() || *at != vertex_key) continue;
      ++known;
      local[k] = static_cast<mesh::LocalIndex>(at - vertex_keys.begin());
      is_own = is_own || _input.problem.owners[local[k]] == Owner::mine;
    }
    if (known < 3 && is_own) throw std::logic_error("a zone lacks a point of the core's border");
    if (known < 3) return;
    _input.problem.borders.push_back(local);
    _input.problem.border_regions.push_back(t.region);
    _input.border_leaves.push_back(t.leaf);
  }

  void add_triangle(const SurfaceTriangle& t, const std::vector<Corner>& corners) {
    LocalTriangle local;
    for (int k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(
          corners.begin(), corners.end(), t.vertices[k],
          [](const Corner& corner, mesh::GlobalIndex number) { return corner.number < number; });
      local[k] = static_cast<mesh::LocalIndex>(at - corners.begin());
    }
    _input.problem.triangles.push_back(local);
    _input.problem.inside.push_back(t.inside);
    _input.problem.outside.push_back(t.outside);
    _input.face.push_back(t.face);
    _input.patch.push_back(t.patch);
  }

  const Lattice& _lattice;
  ZoneInput _input;
};

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

std::vector<ZoneInput> gather_zone_inputs(const Lattice& lattice, const Shell& shell, const SendPlan& plan) {
  ZoneItems sent;
  {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    sent = std::move(ItemCollector(lattice, shell, plan).sent);
  }
  const auto deliver_by_zone = [&](auto& items) {
    items = mesh::deliver(lattice.tree.communicator(), std::move(items),
                          [](const auto& item) { return item.rank; });
    // Ranks have ascending blocks: what comes block by block is by number within each zone.
    const auto before = [](const auto& a, const auto& b) { return a.zone < b.zone; };
    if (!std::is_sorted(items.begin(), items.end(), before))
      std::stable_sort(items.begin(), items.end(), before);
  };
  deliver_by_zone(sent.points);
  deliver_by_zone(sent.at_borders);
  deliver_by_zone(sent.triangles);
  deliver_by_zone(sent.borders);
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  std::vector<ZoneInput> inputs;
  for (ZoneIndex zone = 0; zone < static_cast<ZoneIndex>(plan.ranks.size()); ++zone) {
    const std::span<PointOfZone> near = of_zone(sent.points, zone);
    const std::span<PointOfZone> at_borders = of_zone(sent.at_borders, zone);
    const std::span<TriangleOfZone> triangles = of_zone(sent.triangles, zone);
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
    inputs.push_back(InputBuilder(zone, lattice).build(points, triangles, of_zone(sent.borders, zone)));
  }
  return inputs;
}

}  // namespace aeroloom::volume
