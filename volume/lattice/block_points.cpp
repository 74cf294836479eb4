#include "volume/lattice/block_points.hpp"

#include "mesh/data/mixing.hpp"
#include "volume/lattice/empty_balls.hpp"
#include "volume/lattice/near_triangles.hpp"
#include "volume/lattice/within_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// The size of boundary triangles counts in the clearance as far as it is within these bounds, in local
/// sizes: beyond them the surface is not what sizes ask for. Chosen, not measured.
constexpr double smallest_edge = 0.3, largest_edge = 1.5;
/// The factor by which the clearance grows in each step of a retry, up to the steps that there are:
/// points move off what TetGen could not mesh, and still fill the space. Chosen, not measured.
constexpr double step_factor = 1.6;
constexpr int most_steps = 2;

/// Slots that hang: a point stands there if one of the cells of the leaf's level is split that touch the
/// place from below: their offsets.
struct Touching {
  int slot, count;
  int offsets[3][3];
};
constexpr Touching hanging[] = {{1, 3, {{0, -1, 0}, {0, 0, -1}, {0, -1, -1}}},
                                {2, 3, {{-1, 0, 0}, {0, 0, -1}, {-1, 0, -1}}},
                                {3, 3, {{-1, 0, 0}, {0, -1, 0}, {-1, -1, 0}}},
                                {4, 1, {{0, 0, -1}}},
                                {5, 1, {{0, -1, 0}}},
                                {6, 1, {{-1, 0, 0}}}};

/// The largest size in a block, at most.
double largest_size(const Lattice& lattice, BlockIndex b) {
  const GridCube cell = lattice.tree.cube(b);
  const double half_diagonal = 0.5 * std::numbers::sqrt3 * lattice.frame.edge(cell.level);
  const double slope = slope_margin * std::log(lattice.field.options().growth);
  return std::min(lattice.field.maximum(),
                  lattice.field(lattice.frame.middle_of(cell)) + slope * half_diagonal);
}

/// Radius of the balls around core leaves that no point of the surface stands in, in leaf edges: half a
/// diagonal of the leaf, and what shear and perturbation make of it.
constexpr double core_ball = 0.9;

/// How far the surface is from corners and centres of leaves of the core, in space.
double core_distance(const Lattice& lattice, BlockIndex b) {
  return core_clearance * lattice.frame.edge(lattice.tree.leaf_level(b));
}

double clearance_of(const Lattice& lattice, const BlockChange& change) {
  return lattice.options.lattice_clearance * std::pow(step_factor, change.farther);
}

/// Whether there are far smaller triangles within a distance of the points of a block. Where a block is not
/// local, none is there (fetch_finer_ghosts).
bool sees_far_finer(const Lattice& lattice, BlockIndex b, double radius) {
  const LatticeTree& tree = lattice.tree;
  const int level = far_finer_level(tree.level(b));
  return tree.any_block_in(
      GridBox::of(tree.cube(b)).dilated(radius),
      [&](BlockIndex n) { return tree.level(n) >= level && lattice.table.is_met(n); },
      [&](BlockIndex first, BlockIndex last, const GridCube&) {
        return !lattice.table.any_met(first, last, level);
      });
}

/// Whether leaves of a block may be core at all: not where far smaller triangles would have to be looked at.
bool may_have_core(const Lattice& lattice, BlockIndex b) {
  return !sees_far_finer(lattice, b, lattice.frame.grid_distance(core_distance(lattice, b)));
}

/// Makes the points of one block after the other.
class PointMaker {
public:
  PointMaker(const Lattice& lattice, std::span<const BlockChange> changes, const NearSurface& surface,
             const SearchRadii& radii, BlockPoints& result)
      : _lattice(lattice),
        _changes(changes),
        _surface(surface),
        _radii(radii),
        _result(result),
        _within(lattice, surface) {}

  void make(BlockIndex b) {
    _result.clear_leaves.push_back(0);
    const bool met = _lattice.table.is_met(b);
    if (!met && _lattice.regions[b - _lattice.tree.first()] == mesh::no_region) return;
    _block = b;
    _offered.clear();
    _box = {};
    for (int child = 0; child < _lattice.tree.leaf_count(b); ++child) make_leaf(child);
    const bool near = met || is_near();
    if (near) find_triangles();
    _result.clear_leaves.back() = clear_leaves();
    for (const Offer& offer : _offered) {
      mesh::RegionId region = _lattice.regions[b - _lattice.tree.first()];
      if (near && !is_clear(offer)) continue;
      if (met) region = region_of(offer.point);
      if (region == mesh::no_region) continue;
      _result.slots.push_back(offer.slot);
      _result.points.push_back(offer.point);
      _result.regions.push_back(region);
    }
  }

private:
  /// A point that is made unless something is in the way.
  struct Offer {
    Vec3 point;
    double size;  ///< where triangles may be near
    std::uint8_t slot;
  };

  /// Whether triangles may be too near to a point of the block.
  bool is_near() const {
    if (_surface.empty()) return false;
    const double radius =
        largest_edge * clearance_of(_lattice, _changes[_block]) * largest_size(_lattice, _block);
    return _surface.distance().any_in(_box.dilated(radius));
  }

  /// Triangles near a block's points, and the sizes that decide.
  void find_triangles() {
    double largest = 0;
    for (Offer& offer : _offered) {
      offer.size = _lattice.field(offer.point);
      largest = std::max(largest, offer.size);
    }
    _triangles.collect(_surface.distance(), _box,
                       largest_edge * clearance_of(_lattice, _changes[_block]) * largest);
  }

  /// The leaves whose corners and centre keep off the surface as far as those of the core do.
  std::uint8_t clear_leaves() {
    const LatticeTree& tree = _lattice.tree;
    if (!may_have_core(_lattice, _block)) return 0;
    const double radius = core_distance(_lattice, _block);
    if (_surface.empty()) return tree.all_leaves(_block);
    const geometry::Box box = _lattice.frame.space_box(GridBox::of(tree.cube(_block)));
    if (!_surface.distance().any_in(box.dilated(radius))) return tree.all_leaves(_block);
    _around.collect(_surface.distance(), box, radius);
    std::uint8_t clear = 0;
    for (int child = 0; child < tree.leaf_count(_block); ++child) {
      const GridBox leaf = GridBox::of(tree.leaf(_block, child));
      const auto is_near = [&](Vec3 grid) {
        return _around.any_nearer(_lattice.frame.to_space(grid), {1, radius, radius});
      };
      bool near = is_near(0.5 * (leaf.low + leaf.high));
      for (int corner = 0; corner < 8 && !near; ++corner) near = is_near(leaf.corner(corner));
      // Balls through the corners of squares: of the leaf, and of its octants where finer leaves touch it.
      const double ball = core_ball * _lattice.frame.edge(tree.leaf_level(_block));
      near = near || _around.any_corner_nearer(_lattice.frame.to_space(0.5 * (leaf.low + leaf.high)), ball);
      for (int corner = 0; corner < 8 && !near; ++corner) {
        const Vec3 middle = 0.25 * leaf.corner(corner) + 0.75 * leaf.corner(7 - corner);
        near = _around.any_corner_nearer(_lattice.frame.to_space(middle), 0.5 * ball);
      }
      if (!near) clear |= static_cast<std::uint8_t>(1U << child);
    }
    return clear;
  }

  void make_leaf(int child) {
    const GridCube leaf = _lattice.tree.leaf(_block, child);
    offer(child, 0);
    for (const Touching& touching : hanging) {
      const auto is_split = [&](const int(&offset)[3]) { return is_neighbour_split(leaf, offset); };
      if (std::any_of(touching.offsets, touching.offsets + touching.count, is_split))
        offer(child, touching.slot);
    }
    offer(child, 7);
  }

  bool is_neighbour_split(const GridCube& leaf, const int (&offset)[3]) const {
    const std::uint32_t edge = leaf.edge();
    if ((offset[0] < 0 && leaf.low.x == 0) || (offset[1] < 0 && leaf.low.y == 0) ||
        (offset[2] < 0 && leaf.low.z == 0))
      return false;
    return _lattice.tree.is_split(
        {{leaf.low.x - (offset[0] < 0 ? edge : 0), leaf.low.y - (offset[1] < 0 ? edge : 0),
          leaf.low.z - (offset[2] < 0 ? edge : 0)},
         leaf.level});
  }

  void offer(int child, int slot) {
    const Vec3 p = lattice_point(_lattice, _changes, {_block, child}, slot);
    _offered.push_back({p, 0, static_cast<std::uint8_t>(child * slots_per_leaf + slot)});
    _box.add(p);
  }

  bool is_clear(const Offer& offer) const {
    return !_triangles.any_nearer(offer.point, {clearance_of(_lattice, _changes[_block]),
                                                smallest_edge * offer.size, largest_edge * offer.size});
  }

  /// The region of a point in a block that the surface meets.
  mesh::RegionId region_of(Vec3 p) {
    if (const auto known = _balls.region_at(p)) return *known;
    if (_radii.is_from_within(_block - _result.first)) {
      const auto seen = _within.look(_block, p);
      return seen ? seen->region : mesh::no_region;
    }
    std::optional<BoundaryDistance::Nearest> nearest = _triangles.nearest(p);
    if (!nearest) nearest = _surface.distance().nearest(p, _guess);
    _guess = nearest->triangle;
    const mesh::RegionId region = _surface.region_at(p, *nearest).value_or(mesh::no_region);
    _balls.remember(p, nearest->distance, region);
    return region;
  }

  const Lattice& _lattice;
  std::span<const BlockChange> _changes;
  const NearSurface& _surface;
  const SearchRadii& _radii;
  BlockPoints& _result;
  WithinBlocks _within;
  BlockIndex _block = 0;
  std::vector<Offer> _offered;  // in the block
  geometry::Box _box;           // of them
  NearTriangles _triangles;     // near them
  NearTriangles _around;        // near leaves that may be core
  std::int32_t _guess = -1;
  EmptyBalls _balls;
};

/// Lengths in the frame's grid over those in space: what the frame's shear adds, at most.
constexpr double more_for_shear = 1.1;

/// How far a triangle is from any point of a block that the surface meets, at most, and its inside.
double nearest_in(const Lattice& lattice, BlockIndex b) {
  constexpr double inward = 0.1;  // of the longest edge; chosen, not measured
  const double half_diagonal = 0.5 * std::numbers::sqrt3 * lattice.tree.cube(b).edge();
  return more_for_shear * half_diagonal +
         lattice.frame.grid_distance(lattice.table.nearest[b - lattice.tree.first()] +
                                     inward * lattice.table.longest_edge[b]);
}

/// How far from a block the way may lead from one of its points to a triangle whose box meets it.
double radius_from_within(const Lattice& lattice, BlockIndex b) {
  const double perturbation = lattice.options.perturbation * lattice.tree.cube(b).edge();
  return more_for_shear * lattice.frame.grid_distance(lattice.table.longest_edge[b]) + perturbation;
}

Vec3 perturbation(const Lattice& lattice, const BlockChange& change, const GridCube& leaf, int slot) {
  std::uint64_t state = mesh::mix_in(change.variant, static_cast<std::uint64_t>(slot));
  state = mesh::mix_in(state, static_cast<std::uint64_t>(leaf.level));
  state = mesh::mix_in(state, sizing::morton_key(leaf.low));
  const double width = lattice.options.perturbation * mean_edge_of_cell * lattice.frame.edge(leaf.level);
  Vec3 shift;
  for (int axis = 0; axis < 3; ++axis) {
    state = mesh::mix_in(state, 0);
    shift[axis] = width * (static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
  }
  return shift;
}

}  // namespace

Vec3 lattice_point(const Lattice& lattice, std::span<const BlockChange> changes, const Leaf& leaf, int slot) {
  const GridCube cube = lattice.tree.leaf(leaf);
  const double half = 0.5 * cube.edge();
  const int(&place)[3] = slot_places[slot];
  const Vec3 grid = GridBox::of(cube).low + Vec3{half * place[0], half * place[1], half * place[2]};
  return lattice.frame.to_space(grid) + perturbation(lattice, changes[leaf.block], cube, slot);
}

std::array<double, 2> looks_of_block(const Lattice& lattice, BlockIndex b) {
  return {lattice.frame.grid_distance(core_distance(lattice, b)),
          lattice.table.is_met(b) ? nearest_in(lattice, b) : 0};
}

// Far from a body sizes are large and its triangles small: these matter to few of the blocks there. No point
// of a block that the surface meets is farther from the surface than its centre by more than half a diagonal.
SearchRadii search_radii_of_blocks(const Lattice& lattice, BlockIndex first, BlockIndex last) {
  const double farthest = lattice.options.lattice_clearance * std::pow(step_factor, most_steps);
  SearchRadii radii;
  radii.per_edge = lattice.frame.grid_distance(farthest);
  for (BlockIndex b = first; b < last; ++b) {
    const double clear = lattice.frame.grid_distance(farthest * largest_size(lattice, b));
    const double of_core = lattice.frame.grid_distance(core_distance(lattice, b));
    BlockSearchRadii block{smallest_edge * clear, largest_edge * clear};
    if (lattice.table.is_met(b)) block.nearest = nearest_in(lattice, b);
    // Far finer blocks cost a search. Where all triangles that could matter are at hand none is spared by it.
    const double farthest_of_all = std::max({block.most, block.nearest, of_core});
    const auto [lowest, highest] =
        lattice.tree.range_of(GridBox::of(lattice.tree.cube(b)).dilated(farthest_of_all));
    const bool is_inside = lowest >= first && highest < last;
    if (!is_inside && lattice.table.is_met(b)) {
      block.from_within = sees_far_finer(lattice, b, block.nearest);
      if (block.from_within) block.nearest = radius_from_within(lattice, b);
    }
    if (is_inside || may_have_core(lattice, b)) block.least = std::max(block.least, of_core);
    radii.of_blocks.push_back(block);
  }
  return radii;
}

BlockPoints make_points(const Lattice& lattice, std::span<const BlockChange> changes, BlockIndex first,
                        BlockIndex last, const NearSurface& surface, const SearchRadii& radii) {
  BlockPoints result;
  result.first = first;
  result.starts.push_back(0);
  PointMaker maker(lattice, changes, surface, radii, result);
  for (BlockIndex b = first; b < last; ++b) {
    maker.make(b);
    result.starts.push_back(static_cast<std::int64_t>(result.points.size()));
  }
  return result;
}

}  // namespace aeroloom::volume
