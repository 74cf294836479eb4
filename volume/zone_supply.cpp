#include "volume/zone_supply.hpp"

#include "mesh/delivery.hpp"

#include <algorithm>
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

  static constexpr auto fields() {
    return std::tuple(&PointOfZone::zone, &PointOfZone::rank, &PointOfZone::number, &PointOfZone::point,
                      &PointOfZone::region);
  }
};

struct TriangleOfZone {
  ZoneIndex zone;
  parallel::Rank rank;
  SurfaceTriangle triangle;

  static constexpr auto fields() {
    return std::tuple(&TriangleOfZone::zone, &TriangleOfZone::rank, &TriangleOfZone::triangle);
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

/// What this rank sends.
class Answer {
public:
  Answer(const BlockStore& store, const LatticeFrame& frame, const LatticeTree& tree)
      : _store(store), _frame(frame), _tree(tree), _sent_to(store.triangles.size(), no_zone) {}

  /// Wants come zone by zone.
  void add(const ZoneWant& want) {
    const BlockPoints& all = _store.points;
    for (std::int64_t i = all.starts[want.block - all.first]; i < all.starts[want.block - all.first + 1];
         ++i) {
      if ((want.leaves >> all.slots[i] / slots_per_leaf & 1) == 0) continue;
      points.push_back(
          {want.zone, want.rank, lattice_number(want.block, all.slots[i]), all.points[i], all.regions[i]});
    }
    for (const std::int32_t t : _store.of_blocks.of(want.block)) {
      if (_sent_to[t] == want.zone || !meets(want, _store.triangles[t])) continue;
      _sent_to[t] = want.zone;
      triangles.push_back({want.zone, want.rank, _store.triangles[t]});
    }
    for (const BorderTriangle& t : _store.borders.of(want.block)) {
      if ((want.leaves >> t.child & 1) == 0) continue;
      borders.push_back({want.zone, want.rank, t.points, leaf_number({want.block, t.child}),
                         _store.core.region(want.block)});
    }
  }

  std::vector<PointOfZone> points;
  std::vector<TriangleOfZone> triangles;
  std::vector<BorderOfZone> borders;

private:
  bool meets(const ZoneWant& want, const SurfaceTriangle& triangle) const {
    if (want.leaves == _tree.all_leaves(want.block)) return true;
    const GridBox box = grid_box(_frame, triangle.points);
    for (int child = 0; child < 8; ++child) {
      if ((want.leaves >> child & 1) && GridBox::of(_tree.leaf(want.block, child)).overlaps(box)) return true;
    }
    return false;
  }

  const BlockStore& _store;
  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  std::vector<ZoneIndex> _sent_to;
};

/// A zone's points and triangles become its problem.
class ContentBuilder {
public:
  ContentBuilder(ZoneIndex zone, const ZoneFinder& finder) : _finder(finder) { _content.zone = zone; }

  /// Both by number; triangles that come from several ranks may come several times.
  ZoneContent build(std::span<const PointOfZone> points, std::span<const TriangleOfZone> triangles,
                    std::span<const BorderOfZone> borders) {
    std::vector<Corner> corners;
    for (const auto& [zone, rank, t] : triangles) {
      for (int k = 0; k < 3; ++k)
        corners.push_back({t.vertices[k], t.points[k], t.dimension[k], t.entity[k]});
    }
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.number < b.number; });
    corners.erase(std::unique(corners.begin(), corners.end(),
                              [](const Corner& a, const Corner& b) { return a.number == b.number; }),
                  corners.end());
    for (const Corner& corner : corners) {
      const auto token = mesh::running_token(corner.number);
      add_point(token, corner.point);
      _content.dimension.push_back(corner.dimension);
      _content.entity.push_back(corner.entity);
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (i == 0 || triangles[i].triangle.number != triangles[i - 1].triangle.number)
        add_triangle(triangles[i].triangle, corners);
    }
    for (const PointOfZone& p : points) {
      add_point(_finder.token_of(p.number), p.point);
      _content.problem.regions.push_back(p.region);
    }
    for (const BorderOfZone& t : borders) add_border(t);
    return std::move(_content);
  }

private:
  struct Corner {
    mesh::GlobalIndex number;
    Vec3 point;
    std::int8_t dimension;
    std::int32_t entity;
  };

  void add_point(mesh::SharedToken token, Vec3 p) {
    const ZoneIndex zone = _finder.zone_of(_finder.leaf_of(token, p));
    _content.tokens.push_back(token);
    _content.problem.points.push_back(p);
    _content.problem.owners.push_back(zone == _content.zone  ? Owner::mine
                                      : zone < _content.zone ? Owner::lower
                                                             : Owner::higher);
  }

  void add_border(const BorderOfZone& t) {
    const std::vector<mesh::SharedToken>& tokens = _content.tokens;
    LocalTriangle local;
    for (int k = 0; k < 3; ++k) {
      const mesh::SharedToken token = _finder.token_of(t.points[k]);
      const auto at = std::lower_bound(tokens.begin(), tokens.end(), token);
      if (at == tokens.end() || *at != token)
        throw std::logic_error("a zone does not know a point of the core's border");
      local[k] = static_cast<mesh::LocalIndex>(at - tokens.begin());
    }
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

/// Leaves out what came with the leaves of zones and is not near enough.
class Trimmer {
public:
  Trimmer(const BlockTables& blocks, const ZoneFinder& finder, std::span<const double> widths)
      : _frame(blocks.frame),
        _finder(finder),
        _widths(widths),
        _own_blocks(list_blocks(blocks.tree, blocks.zones)),
        _surroundings(blocks.frame, blocks.tree, blocks.table, blocks.zones) {}

  void trim(ZoneIndex zone, std::vector<PointOfZone>& points, std::vector<TriangleOfZone>& triangles,
            std::vector<BorderOfZone>& borders) {
    _surroundings.move_to(zone, _own_blocks.of(zone));
    const double width = _widths[zone];
    const auto is_own_point = [&](std::int64_t number) {
      return _finder.zone_of(leaf_of_lattice(number)) == zone;
    };
    // Triangles at the zone's own points come with all of theirs; others where their points are known anyway.
    std::vector<std::int64_t> at_border;
    for (const BorderOfZone& t : borders) {
      if (std::any_of(t.points.begin(), t.points.end(), is_own_point))
        at_border.insert(at_border.end(), t.points.begin(), t.points.end());
    }
    std::sort(at_border.begin(), at_border.end());
    std::erase_if(points, [&](const PointOfZone& p) {
      const Leaf leaf = leaf_of_lattice(p.number);
      if (_finder.zone_of(leaf) == zone) return false;
      if (std::binary_search(at_border.begin(), at_border.end(), p.number)) return false;
      const Vec3 place = _frame.to_grid(p.point);
      return !_surroundings.is_near({place, place}, leaf.block, width);
    });
    std::erase_if(borders, [&](const BorderOfZone& t) {
      return !std::all_of(t.points.begin(), t.points.end(), [&](std::int64_t number) {
        const auto at =
            std::lower_bound(points.begin(), points.end(), number,
                             [](const PointOfZone& p, std::int64_t wanted) { return p.number < wanted; });
        return at != points.end() && at->number == number;
      });
    });
    std::erase_if(triangles, [&](const TriangleOfZone& t) {
      const auto& p = t.triangle.points;
      const auto is_own = [&](Vec3 q) { return _finder.zone_of(_finder.leaf_of_place(q)) == zone; };
      if (std::any_of(p.begin(), p.end(), is_own)) return false;
      const BlockIndex middle = _finder.leaf_of_place((1.0 / 3.0) * (p[0] + p[1] + p[2])).block;
      return !_surroundings.is_near(grid_box(_frame, p), middle, width);
    });
  }

private:
  const LatticeFrame& _frame;
  const ZoneFinder& _finder;
  std::span<const double> _widths;
  BlocksOfZones _own_blocks;
  ZoneSurroundings _surroundings;
};

/// Groups items by zone, without changing their order within one.
template <class Item>
void sort_by_zone(std::vector<Item>& items) {
  const auto before = [](const Item& a, const Item& b) { return a.zone < b.zone; };
  if (!std::is_sorted(items.begin(), items.end(), before))
    std::stable_sort(items.begin(), items.end(), before);
}

}  // namespace

std::vector<ZoneContent> supply_zones(const parallel::Communicator& communicator, const BlockTables& blocks,
                                      const BlockStore& store, const ZoneFinder& finder,
                                      std::span<const BlockIndex> shares, std::span<const double> widths,
                                      const std::vector<ZoneWant>& wants, parallel::StageClock& clock) {
  const auto owner = [&](const ZoneWant& want) {
    return static_cast<parallel::Rank>(std::upper_bound(shares.begin(), shares.end() - 1, want.block) -
                                       shares.begin() - 1);
  };
  std::vector<ZoneWant> asked = mesh::deliver(communicator, wants, owner);
  Answer answer(store, blocks.frame, blocks.tree);
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    sort_by_zone(asked);
    for (const ZoneWant& want : asked) answer.add(want);
    asked = {};
  }
  // Ranks have ascending blocks, so what arrives is by number within each zone.
  std::vector<PointOfZone> points =
      mesh::deliver(communicator, std::move(answer.points), [](const PointOfZone& p) { return p.rank; });
  std::vector<TriangleOfZone> triangles = mesh::deliver(communicator, std::move(answer.triangles),
                                                        [](const TriangleOfZone& t) { return t.rank; });
  std::vector<BorderOfZone> borders =
      mesh::deliver(communicator, std::move(answer.borders), [](const BorderOfZone& t) { return t.rank; });
  const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
  sort_by_zone(points);
  sort_by_zone(borders);
  std::sort(triangles.begin(), triangles.end(), [](const TriangleOfZone& a, const TriangleOfZone& b) {
    return a.zone != b.zone ? a.zone < b.zone : a.triangle.number < b.triangle.number;
  });
  Trimmer trimmer(blocks, finder, widths);
  std::vector<ZoneContent> contents;
  auto p = points.begin();
  auto t = triangles.begin();
  auto c = borders.begin();
  while (p != points.end() || t != triangles.end()) {
    const ZoneIndex zone =
        std::min(p != points.end() ? p->zone : INT32_MAX, t != triangles.end() ? t->zone : INT32_MAX);
    const auto is_of_another = [&](const auto& item) { return item.zone != zone; };
    const auto last_p = std::find_if(p, points.end(), is_of_another);
    const auto last_t = std::find_if(t, triangles.end(), is_of_another);
    std::vector<PointOfZone> its_points(p, last_p);
    c = std::find_if(c, borders.end(), [&](const BorderOfZone& item) { return item.zone >= zone; });
    const auto last_c = std::find_if(c, borders.end(), is_of_another);
    std::vector<TriangleOfZone> its_triangles(t, last_t);
    std::vector<BorderOfZone> its_borders(c, last_c);
    trimmer.trim(zone, its_points, its_triangles, its_borders);
    contents.push_back(ContentBuilder(zone, finder).build(its_points, its_triangles, its_borders));
    p = last_p, t = last_t, c = last_c;
  }
  return contents;
}

}  // namespace aeroloom::volume
