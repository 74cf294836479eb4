/// The graded body-centred lattice, block by block.
#include "volume/lattice/block_points.hpp"

#include "mesh/quality/quality.hpp"
#include "tests/several_ranks.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"
#include "volume/filling/tetgen_run.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::RegionId;
using parallel::Communicator;

/// A place of the lattice, in halves of the finest cells.
using Place = std::array<std::int64_t, 3>;

/// [-1.5,1.5]^3 with region 1 in its inner half, [-0.75,0.75]^3, among sizes that change.
surfaces::Surface nested() {
  surfaces::Surface surface = surfaces::nested_cubes(12);
  for (Vec3& p : surface.points) p *= 1.5;
  return surface;
}
RegionId region_of(Vec3 p) {
  const double r = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return r < 0.75 ? 1 : r < 1.5 ? 0 : mesh::no_region;
}

struct Made {
  explicit Made(const Communicator& communicator, VolumeOptions options = {})
      : Made(communicator, nested(), fields::around_unit_sphere(0.08, 0.4), options) {}
  Made(const Communicator& communicator, surfaces::Surface of, const sizing::SizeField& field,
       VolumeOptions options = {})
      : surface(std::move(of)),
        problem(communicator, surface, field, options),
        lattice(problem, box_of(surface)),
        around(lattice) {}

  BlockPoints make() const { return make(lattice.tree.first(), lattice.tree.last()); }
  BlockPoints make(BlockIndex first, BlockIndex last) const {
    return make_points(lattice, lattice.changes, first, last, around.surface,
                       search_radii_of_blocks(lattice, first, last));
  }

  surfaces::Surface surface;
  Problem problem;
  GrownLattice lattice;
  Surroundings around;
};

template <class Visit>
void for_each_point(const BlockPoints& points, const Visit& visit) {
  for (BlockIndex b = points.first; b < points.last(); ++b) {
    for (std::int64_t i = points.starts[b - points.first]; i < points.starts[b - points.first + 1]; ++i)
      visit(b, i);
  }
}

/// Corners and centres of all leaves.
std::set<Place> all_places(const Lattice& lattice) {
  std::set<Place> places;
  for (const LeafOfBlock& leaf : all_leaves(lattice.tree)) {
    const Place low{2 * std::int64_t{leaf.cell.low.x}, 2 * std::int64_t{leaf.cell.low.y},
                    2 * std::int64_t{leaf.cell.low.z}};
    const std::int64_t edge = leaf.cell.edge();
    const auto add = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
      places.insert({low[0] + dx, low[1] + dy, low[2] + dz});
    };
    add(edge, edge, edge);
    for (int k = 0; k < 8; ++k) add(k & 1 ? 2 * edge : 0, k & 2 ? 2 * edge : 0, k & 4 ? 2 * edge : 0);
  }
  return places;
}

Vec3 place_in_space(const Lattice& lattice, const Place& place) {
  return lattice.frame.to_space({0.5 * double(place[0]), 0.5 * double(place[1]), 0.5 * double(place[2])});
}

/// Where a slot of a leaf stands, by what the header says of slots.
Place place_of_slot(const LatticeTree& tree, BlockIndex b, int slot) {
  const GridCube leaf = tree.leaf(b, slot / slots_per_leaf);
  const int in_leaf = slot % slots_per_leaf;
  const std::set<int> middles[8] = {{}, {0}, {1}, {2}, {0, 1}, {0, 2}, {1, 2}, {0, 1, 2}};
  Place place{2 * std::int64_t{leaf.low.x}, 2 * std::int64_t{leaf.low.y}, 2 * std::int64_t{leaf.low.z}};
  for (const int axis : middles[in_leaf]) place[axis] += leaf.edge();
  return place;
}

TEST(LatticePointsLocal, stand_at_corners_and_centres_of_leaves_each_place_once) {
  const Made made(Communicator::self());
  const BlockPoints points = made.make();
  const std::set<Place> places = all_places(made.lattice);
  std::set<Place> used;
  std::array<int, slots_per_leaf> of_slot{};
  for_each_point(points, [&](BlockIndex b, std::int64_t i) {
    const Place place = place_of_slot(made.lattice.tree, b, points.slots[i]);
    ASSERT_TRUE(places.count(place));
    EXPECT_TRUE(used.insert(place).second);
    ++of_slot[points.slots[i] % slots_per_leaf];
    const double most =
        0.5 * 0.005 * mean_edge_of_cell * made.lattice.frame.edge(made.lattice.tree.leaf_level(b));
    const Vec3 off = points.points[i] - place_in_space(made.lattice, place);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(off[axis]), most);
  });
  for (const int count : of_slot) EXPECT_GT(count, 20);  // the lattice hangs in all possible ways
}

TEST(LatticePointsLocal, leave_out_nothing_that_is_off_the_surface) {
  const Made made(Communicator::self());
  const BlockPoints points = made.make();
  std::set<Place> used;
  for_each_point(points, [&](BlockIndex b, std::int64_t i) {
    used.insert(place_of_slot(made.lattice.tree, b, points.slots[i]));
  });
  int free = 0;
  for (const Place& place : all_places(made.lattice)) {
    const Vec3 p = place_in_space(made.lattice, place);
    if (region_of(p) == mesh::no_region) continue;
    const auto nearest = made.around.surface.distance().nearest(p);
    if (nearest.distance < 1.02 * 0.75 * 1.5 * made.problem.surface.field(p)) continue;
    ++free;
    EXPECT_TRUE(used.count(place)) << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_GT(free, 2000);
  EXPECT_GT(static_cast<int>(used.size()), free);
}

TEST(LatticePointsLocal, stay_inside_and_know_their_region) {
  const Made made(Communicator::self());
  const BlockPoints points = made.make();
  std::array<int, 2> count{};
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    ASSERT_EQ(points.regions[i], region_of(points.points[i]));
    ++count[points.regions[i]];
  }
  EXPECT_GT(count[0], 1000);
  EXPECT_GT(count[1], 500);
}

/// The least of distance over size: that of the triangle, as far as it is within 0.3 and 1.5 of what is asked
/// for.
double least_clearance(const Made& made, const BlockPoints& points) {
  const BoundaryDistance& distance = made.around.surface.distance();
  double least = 1e300;
  for (const Vec3& p : points.points) {
    const double size = made.problem.surface.field(p);
    for (std::size_t t = 0; t < made.around.triangles.size(); ++t) {
      const auto triangle = static_cast<std::int32_t>(t);
      // The ball around the triangle is far enough off for most.
      const auto& [a, b, c] = made.around.triangles[t].points;
      if (geometry::distance(p, a) - std::max(geometry::distance(a, b), geometry::distance(a, c)) >
          1.5 * size * least)
        continue;
      least = std::min(least, distance.distance_to(p, triangle) /
                                  std::clamp(distance.mean_edge(triangle), 0.3 * size, 1.5 * size));
    }
  }
  return least;
}

TEST(LatticePointsLocal, keep_off_the_surface) {
  for (const double clearance : {0.5, 0.75}) {
    VolumeOptions options;
    options.lattice_clearance = clearance;
    const Made made(Communicator::self(), options);
    const double least = least_clearance(made, made.make());
    EXPECT_GE(least, clearance);
    EXPECT_LT(least, 1.6 * clearance);
  }
}

/// Large triangles next to small ones, and corners that look at the blocks around them.
surfaces::Surface uneven() {
  const std::array<int, 3> n{10, 10, 10};
  const auto graded = [](double t) { return 1.5 * std::copysign(std::pow(std::abs(t), 2.5), t); };
  surfaces::Surface surface = surfaces::voxels(
      n, [](int, int, int) { return 0; },
      [&](Vec3 grid) {
        const Vec3 p = 0.2 * grid - Vec3{1, 1, 1};
        return Vec3{graded(p.x), graded(p.y), graded(p.z)};
      });
  for (int k = 0; k < 27; ++k) {
    const int column = k % 3 - 1, row = k / 3 % 3 - 1, layer = k / 9 - 1;
    const Vec3 center{0.71 * column, 0.67 * row, 0.73 * layer};
    surfaces::append(surface, surfaces::cube(center, 0.08, k % 2 ? 1 : 4), surfaces::Turn::inward);
  }
  return surface;
}

TEST(LatticePointsLocal, keep_off_triangles_of_any_size) {
  for (const double size : {0.14, 0.2}) {
    const Made made(Communicator::self(), uneven(), fields::uniform(size));
    const double least = least_clearance(made, made.make());
    EXPECT_GE(least, VolumeOptions{}.lattice_clearance);
    EXPECT_LT(least, 1.3 * VolumeOptions{}.lattice_clearance);
  }
}

/// Regions told from within blocks, by what meets these, are those that the nearest triangle tells.
TEST(LatticePointsLocal, have_their_regions_from_their_block_too) {
  surfaces::Surface body = surfaces::cube({0, 0, 0}, 20, 8);
  surfaces::append(body, surfaces::sphere({0, 0, 0}, 1, 24), surfaces::Turn::inward);
  const auto far = fields::around_unit_sphere(0.06, 3, 1.3, {{-20, -20, -20}, {20, 20, 20}});
  for (const Made& made : {Made(Communicator::self(), body, far), Made(Communicator::self())}) {
    const BlockIndex count = made.lattice.tree.block_count();
    SearchRadii radii = search_radii_of_blocks(made.lattice, 0, count);
    for (BlockIndex b = 0; b < count; ++b)
      radii.of_blocks[b].region_from_block = made.lattice.table.is_met(b);
    const BlockPoints near = make_points(made.lattice, made.lattice.changes, 0, count, made.around.surface);
    const BlockPoints within =
        make_points(made.lattice, made.lattice.changes, 0, count, made.around.surface, radii);

    EXPECT_EQ(within.slots, near.slots);
    EXPECT_EQ(within.regions, near.regions);
    EXPECT_GT(near.slots.size(), 0U);
  }
}

/// A rank has no other triangles than those within the search radii of its blocks.
class WithinRadiiLocal : public testing::TestWithParam<double> {};

TEST_P(WithinRadiiLocal, are_all_triangles_that_points_need) {
  Made made(Communicator::self(), uneven(), fields::uniform(GetParam()));
  const LatticeTree& tree = made.lattice.tree;
  std::vector<std::vector<std::int32_t>> of_blocks(tree.block_count());
  for (std::size_t t = 0; t < made.around.triangles.size(); ++t) {
    tree.for_each_block_in(grid_box(made.lattice.frame, made.around.triangles[t].points),
                           [&](BlockIndex b) { of_blocks[b].push_back(static_cast<std::int32_t>(t)); });
  }
  for (const std::uint8_t farther : {0, 2}) {
    for (BlockChange& change : made.lattice.changes) change.farther = farther;
    const BlockPoints whole = made.make();
    std::size_t fewest = made.around.triangles.size();
    for (BlockIndex first = 0; first < tree.block_count(); first += 13) {
      const BlockIndex last = std::min(tree.block_count(), first + 13);
      std::set<std::int32_t> known;
      const SearchRadii radii = search_radii_of_blocks(made.lattice, first, last);
      for (BlockIndex b = first; b < last; ++b) {
        const double least = std::max(radii.of_blocks[b - first].least, radii.of_blocks[b - first].nearest);
        const double most = std::max(radii.of_blocks[b - first].most, least);
        const GridBox box = GridBox::of(tree.cube(b));
        tree.for_each_block_in(box.dilated(most), [&](BlockIndex n) {
          const double edge = made.lattice.table.longest_edge[n];
          if (box.gap_to(GridBox::of(tree.cube(n))) <= std::max(least, radii.per_edge * edge))
            known.insert(of_blocks[n].begin(), of_blocks[n].end());
        });
      }
      std::vector<SurfaceTriangle> triangles;
      for (const std::int32_t t : known) triangles.push_back(made.around.triangles[t]);
      fewest = std::min(fewest, triangles.size());
      const BlockPoints part =
          make_points(made.lattice, made.lattice.changes, first, last, LocalSurface(triangles), radii);
      const auto from = static_cast<std::ptrdiff_t>(whole.starts[first]);
      ASSERT_EQ(static_cast<std::int64_t>(part.points.size()), whole.starts[last] - whole.starts[first]);
      EXPECT_TRUE(std::equal(part.points.begin(), part.points.end(), whole.points.begin() + from));
      EXPECT_TRUE(std::equal(part.regions.begin(), part.regions.end(), whole.regions.begin() + from));
    }
    EXPECT_LT(fewest, made.around.triangles.size() / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(all, WithinRadiiLocal, testing::Values(0.1, 0.125));

TEST(LatticePointsLocal, keep_farther_off_where_a_retry_wants_it) {
  Made made(Communicator::self());
  const BlockPoints before = made.make();
  for (BlockChange& change : made.lattice.changes) change.farther = 1;
  const BlockPoints after = made.make();
  EXPECT_LT(after.points.size(), before.points.size());
  EXPECT_GE(least_clearance(made, after), 1.6 * VolumeOptions{}.lattice_clearance);
  // In its own blocks only.
  const BlockIndex changed = made.lattice.tree.block_count() / 2;
  for (BlockIndex b = 0; b < changed; ++b) made.lattice.changes[b].farther = 0;
  const BlockPoints half = made.make();
  for (BlockIndex b = 0; b < made.lattice.tree.block_count(); ++b)
    EXPECT_EQ(half.count(b), (b < changed ? before : after).count(b));
}

TEST(LatticePointsLocal, are_the_same_however_blocks_are_divided) {
  const Made made(Communicator::self());
  const BlockPoints whole = made.make();
  const BlockIndex blocks = made.lattice.tree.block_count();
  for (const BlockIndex step : {blocks / 2, blocks / 7, BlockIndex{37}}) {
    std::vector<Vec3> points;
    std::vector<std::uint8_t> slots;
    std::vector<RegionId> regions;
    for (BlockIndex first = 0; first < blocks; first += step) {
      const BlockPoints part = made.make(first, std::min(blocks, first + step));
      EXPECT_EQ(part.last(), std::min(blocks, first + step));
      points.insert(points.end(), part.points.begin(), part.points.end());
      slots.insert(slots.end(), part.slots.begin(), part.slots.end());
      regions.insert(regions.end(), part.regions.begin(), part.regions.end());
    }
    EXPECT_EQ(points, whole.points);
    EXPECT_EQ(slots, whole.slots);
    EXPECT_EQ(regions, whole.regions);
  }
}

/// With the triangles within the search radii of the blocks alone, retries included.
TEST(PointsOfRanks, are_the_same_on_any_number_of_ranks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  const std::array<int, 3> n{20, 5, 5};
  const surfaces::Surface bar = surfaces::voxels(
      n, [](int i, int, int) { return i < 9 ? 0 : 1; }, surfaces::onto({-2, -0.5, -0.5}, {2, 0.5, 0.5}, n));
  for (const std::uint8_t farther : {0, 1, 2}) {
    Made alone(Communicator::self(), bar, fields::uniform(0.06)), shared(world, bar, fields::uniform(0.06));
    for (BlockChange& change : alone.lattice.changes) change.farther = farther;
    for (BlockChange& change : shared.lattice.changes) change.farther = farther;
    const auto all = static_cast<std::int64_t>(bar.triangles.size());
    const std::int64_t known = world.sum(static_cast<std::int64_t>(shared.around.triangles.size()));
    EXPECT_TRUE(world.size() == 1 || known < world.size() * all);
    const BlockPoints whole = alone.make(), mine = shared.make();
    EXPECT_EQ(world.all_gather_items<Vec3>(mine.points), whole.points);
    EXPECT_EQ(world.all_gather_items<std::uint8_t>(mine.slots), whole.slots);
    EXPECT_EQ(world.all_gather_items<RegionId>(mine.regions), whole.regions);
  }
}

TEST(LatticePointsLocal, move_by_their_perturbation_in_another_variant) {
  Made made(Communicator::self());
  std::map<std::int64_t, Vec3> before;
  const BlockPoints first = made.make();
  for_each_point(first, [&](BlockIndex b, std::int64_t i) {
    before[lattice_number(made.lattice.tree, b, first.slots[i])] = first.points[i];
  });
  const BlockIndex changed = made.lattice.tree.block_count() / 2;
  for (BlockIndex b = changed; b < made.lattice.tree.block_count(); ++b) made.lattice.changes[b].variant = 1;
  const BlockPoints second = made.make();
  int moved = 0, common = 0;
  double farthest = 0;
  for_each_point(second, [&](BlockIndex b, std::int64_t i) {
    const auto at = before.find(lattice_number(made.lattice.tree, b, second.slots[i]));
    if (at == before.end()) return;  // near the surface, where it came near or went away
    ++common;
    const Vec3 by = second.points[i] - at->second;
    if (b < changed) {
      EXPECT_EQ(norm(by), 0);
      return;
    }
    ++moved;
    const double most = 0.005 * mean_edge_of_cell * made.lattice.frame.edge(made.lattice.tree.leaf_level(b));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(std::abs(by[axis]), most);
      farthest = std::max(farthest, std::abs(by[axis]) / most);
    }
    EXPECT_GT(norm(by), 0);
  });
  EXPECT_GT(moved, 500);
  EXPECT_GT(farthest, 0.7);
  EXPECT_GT(common, static_cast<int>(0.97 * static_cast<double>(before.size())));
}

TEST(LatticePointsLocal, follow_the_perturbation_asked_for) {
  VolumeOptions still;
  still.perturbation = 0;
  const Made made(Communicator::self(), still);
  const BlockPoints points = made.make();
  for_each_point(points, [&](BlockIndex b, std::int64_t i) {
    const Vec3 place = place_in_space(made.lattice, place_of_slot(made.lattice.tree, b, points.slots[i]));
    EXPECT_EQ(points.points[i], place);
  });
  EXPECT_GT(points.points.size(), 2000u);
}

}  // namespace
}  // namespace aeroloom::volume
