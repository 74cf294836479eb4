#include "volume/lattice/block_points.hpp"

#include "mesh/data/mixing.hpp"
#include "volume/lattice/empty_balls.hpp"
#include "volume/lattice/region_in_block.hpp"
#include "volume/lattice/triangle_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// Bounds of the mean edge of a triangle in the clearance, in local sizes. Beyond them triangles do not have
/// the requested size. Chosen, not measured.
constexpr double smallest_edge = 0.3, largest_edge = 1.5;
/// The factor by which a retry increases the clearance, and the largest number of such steps. Points move
/// away from what TetGen could not mesh, and still fill the space. Chosen, not measured.
constexpr double step_factor = 1.6;
constexpr int most_steps = 2;

/// Slots in the middle of edges and faces. They have a point if one of the cubes at these offsets, of the
/// size of the leaf, is split.
struct MiddleSlot {
  int slot, count;
  int offsets[3][3];
};
constexpr MiddleSlot middle_slots[] = {{1, 3, {{0, -1, 0}, {0, 0, -1}, {0, -1, -1}}},
                                       {2, 3, {{-1, 0, 0}, {0, 0, -1}, {-1, 0, -1}}},
                                       {3, 3, {{-1, 0, 0}, {0, -1, 0}, {-1, -1, 0}}},
                                       {4, 1, {{0, 0, -1}}},
                                       {5, 1, {{0, -1, 0}}},
                                       {6, 1, {{-1, 0, 0}}}};

/// An upper bound for the sizes in a block.
double largest_size(const Lattice& lattice, BlockIndex b) {
  const GridCube cell = lattice.tree.cube(b);
  const double half_diagonal = 0.5 * std::numbers::sqrt3 * lattice.frame.edge(cell.level);
  const double slope = slope_margin * std::log(lattice.field.options().growth);
  return std::min(lattice.field.maximum(),
                  lattice.field(lattice.frame.middle_of(cell)) + slope * half_diagonal);
}

/// Radius of the balls around core leaves that contain no surface vertex, in leaf edges: half a diagonal of
/// the leaf, enlarged for shear and perturbation.
constexpr double core_ball = 0.9;

/// The least distance of corners and centres of core leaves from the surface, in space.
double core_distance(const Lattice& lattice, BlockIndex b) {
  return core_clearance * lattice.frame.edge(lattice.tree.leaf_level(b));
}

double clearance_of(const Lattice& lattice, const BlockChange& change) {
  return lattice.options.lattice_clearance * std::pow(step_factor, change.farther);
}

/// Whether a far finer block that the surface meets is within a radius of a block. Such blocks of other ranks
/// are local by fetch_finer_ghosts().
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

/// Whether leaves of a block can be core. They cannot if far finer blocks on the surface are near.
bool may_have_core(const Lattice& lattice, BlockIndex b) {
  return !sees_far_finer(lattice, b, lattice.frame.grid_distance(core_distance(lattice, b)));
}

/// Makes the points of one block after the other.
class PointMaker {
public:
  PointMaker(const Lattice& lattice, std::span<const BlockChange> changes, const LocalSurface& surface,
             const SearchRadii& radii, BlockPoints& result)
      : _lattice(lattice),
        _changes(changes),
        _surface(surface),
        _radii(radii),
        _result(result),
        _in_block(lattice, surface) {}

  void make(BlockIndex b) {
    _result.clear_leaves.push_back(0);
    const bool met = _lattice.table.is_met(b);
    if (!met && _lattice.regions[b - _lattice.tree.first()] == mesh::no_region) return;
    _block = b;
    _candidates.clear();
    _box = {};
    for (int child = 0; child < _lattice.tree.leaf_count(b); ++child) make_leaf(child);
    const bool near = met || is_near();
    if (near) find_triangles();
    _result.clear_leaves.back() = clear_leaves();
    for (const Candidate& candidate : _candidates) {
      mesh::RegionId region = _lattice.regions[b - _lattice.tree.first()];
      if (near && !is_clear(candidate)) continue;
      if (met) region = region_of(candidate.point);
      if (region == mesh::no_region) continue;
      _result.slots.push_back(candidate.slot);
      _result.points.push_back(candidate.point);
      _result.regions.push_back(region);
    }
  }

private:
  /// A point that is made unless it is too near to the surface or outside.
  struct Candidate {
    Vec3 point;
    double size;  ///< local size, if triangles may be near
    std::uint8_t slot;
  };

  /// Whether triangles may be too near to a point of the block.
  bool is_near() const {
    if (_surface.empty()) return false;
    const double radius =
        largest_edge * clearance_of(_lattice, _changes[_block]) * largest_size(_lattice, _block);
    return _surface.distance().any_in(_box.dilated(radius));
  }

  /// Finds the sizes at the offered points, and the triangles near them.
  void find_triangles() {
    double largest = 0;
    for (Candidate& candidate : _candidates) {
      candidate.size = _lattice.field(candidate.point);
      largest = std::max(largest, candidate.size);
    }
    _triangles.collect(_surface.distance(), _box,
                       largest_edge * clearance_of(_lattice, _changes[_block]) * largest);
  }

  /// The leaves whose corners and centre are as far from the surface as core leaves must be, as bits.
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
    add_candidate(child, 0);
    for (const MiddleSlot& middle : middle_slots) {
      const auto is_split = [&](const int(&offset)[3]) { return is_neighbour_split(leaf, offset); };
      if (std::any_of(middle.offsets, middle.offsets + middle.count, is_split))
        add_candidate(child, middle.slot);
    }
    add_candidate(child, 7);
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

  void add_candidate(int child, int slot) {
    const Vec3 p = lattice_point(_lattice, _changes, {_block, child}, slot);
    _candidates.push_back({p, 0, static_cast<std::uint8_t>(child * slots_per_leaf + slot)});
    _box.add(p);
  }

  bool is_clear(const Candidate& candidate) const {
    return !_triangles.any_nearer(candidate.point,
                                  {clearance_of(_lattice, _changes[_block]), smallest_edge * candidate.size,
                                   largest_edge * candidate.size});
  }

  /// The region of a point in a block that the surface meets.
  mesh::RegionId region_of(Vec3 p) {
    if (const auto known = _balls.region_at(p)) return *known;
    if (_radii.is_region_from_block(_block - _result.first)) {
      const auto found = _in_block.find(_block, p);
      return found ? found->region : mesh::no_region;
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
  const LocalSurface& _surface;
  const SearchRadii& _radii;
  BlockPoints& _result;
  RegionInBlock _in_block;
  BlockIndex _block = 0;
  std::vector<Candidate> _candidates;  // points of the block
  geometry::Box _box;                  // of these points
  TriangleCandidates _triangles;       // near these points
  TriangleCandidates _around;          // near leaves that may be core
  std::int32_t _guess = -1;
  EmptyBalls _balls;
};

/// The largest factor by which the shear of the frame can change lengths.
constexpr double more_for_shear = 1.1;

/// An upper bound for the distance from a point of a block that the surface meets to the inside of a
/// triangle.
double nearest_in(const Lattice& lattice, BlockIndex b) {
  constexpr double inward = 0.1;  // of the longest edge; chosen, not measured
  const double half_diagonal = 0.5 * std::numbers::sqrt3 * lattice.tree.cube(b).edge();
  return more_for_shear * half_diagonal +
         lattice.frame.grid_distance(lattice.table.nearest[b - lattice.tree.first()] +
                                     inward * lattice.table.longest_edge[b]);
}

/// How far the line from a point of a block to a triangle whose box meets it can leave the block.
double radius_from_block(const Lattice& lattice, BlockIndex b) {
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

std::array<double, 2> finer_search_radii(const Lattice& lattice, BlockIndex b) {
  return {lattice.frame.grid_distance(core_distance(lattice, b)),
          lattice.table.is_met(b) ? nearest_in(lattice, b) : 0};
}

// Far from a body, blocks are large and triangles small, so few triangles matter to many blocks. In a block
// that the surface meets, no point is farther from it than the centre by more than half a diagonal.
SearchRadii search_radii_of_blocks(const Lattice& lattice, BlockIndex first, BlockIndex last) {
  const double farthest = lattice.options.lattice_clearance * std::pow(step_factor, most_steps);
  SearchRadii radii;
  radii.per_edge = lattice.frame.grid_distance(farthest);
  for (BlockIndex b = first; b < last; ++b) {
    const double clear = lattice.frame.grid_distance(farthest * largest_size(lattice, b));
    const double of_core = lattice.frame.grid_distance(core_distance(lattice, b));
    BlockSearchRadii block{smallest_edge * clear, largest_edge * clear};
    if (lattice.table.is_met(b)) block.nearest = nearest_in(lattice, b);
    // The search for far finer blocks saves nothing where all triangles that can matter are on this rank.
    const double farthest_of_all = std::max({block.most, block.nearest, of_core});
    const auto [lowest, highest] =
        lattice.tree.range_of(GridBox::of(lattice.tree.cube(b)).dilated(farthest_of_all));
    const bool is_inside = lowest >= first && highest < last;
    if (!is_inside && lattice.table.is_met(b)) {
      block.region_from_block = sees_far_finer(lattice, b, block.nearest);
      if (block.region_from_block) block.nearest = radius_from_block(lattice, b);
    }
    if (is_inside || may_have_core(lattice, b)) block.least = std::max(block.least, of_core);
    radii.of_blocks.push_back(block);
  }
  return radii;
}

BlockPoints make_points(const Lattice& lattice, std::span<const BlockChange> changes, BlockIndex first,
                        BlockIndex last, const LocalSurface& surface, const SearchRadii& radii) {
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
