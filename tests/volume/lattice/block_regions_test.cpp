/// Which region the blocks lie in that the surface does not meet.
#include "volume/lattice/block_regions.hpp"

#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::no_region;
using mesh::RegionId;
using parallel::Communicator;

/// Compares with the region that `expected(p)` says the corners and centre of each block lie in, and returns
/// how many blocks are in each region, those outside first.
std::vector<int> expect_regions(const surfaces::Surface& surface, const sizing::SizeField& field,
                                const std::function<RegionId(Vec3)>& expected) {
  const Problem problem(Communicator::world(), surface, field);
  GrownLattice lattice(problem, box_of(surface));
  const Surroundings around(lattice);
  std::vector<int> counts(surfaces::region_count(surface) + 1, 0);
  int wrong = 0;
  EXPECT_EQ(static_cast<BlockIndex>(lattice.regions.size()), lattice.tree.last() - lattice.tree.first());
  const Communicator& ranks = problem.communicator;
  for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last(); ++b) {
    const RegionId region = lattice.regions[b - lattice.tree.first()];
    if (lattice.table.is_met(b)) {
      EXPECT_EQ(region, no_region);
      continue;
    }
    ++counts[region + 1];
    const GridBox box = GridBox::of(lattice.tree.cube(b));
    const Vec3 size = box.high - box.low;
    for (int k = 0; k < 9; ++k) {
      const Vec3 part = k == 8 ? Vec3{0.5, 0.5, 0.5}
                               : Vec3{0.01 + 0.98 * (k & 1), 0.01 + 0.49 * (k & 2), 0.01 + 0.245 * (k & 4)};
      const Vec3 p =
          lattice.frame.to_space(box.low + Vec3{part.x * size.x, part.y * size.y, part.z * size.z});
      wrong += expected(p) != region;
    }
  }
  EXPECT_EQ(wrong, 0);
  for (int& count : counts) count = static_cast<int>(ranks.sum(std::int64_t{count}));
  return counts;
}

RegionId in_box(Vec3 p, double r) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < r ? 0 : no_region;
}

TEST(BlockRegions, are_right_inside_and_outside_of_a_cube) {
  const auto counts = expect_regions(surfaces::cube({0, 0, 0}, 1, 6), fields::uniform(0.08),
                                     [](Vec3 p) { return in_box(p, 1); });
  EXPECT_GT(counts[0], 50);
  EXPECT_GT(counts[1], 50);
}

TEST(BlockRegions, are_right_in_nested_voids) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 2, 8);
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 1.4, 6), surfaces::Turn::inward);
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 0.8, 4));
  const auto counts = expect_regions(surface, fields::uniform(0.08), [](Vec3 p) {
    return in_box(p, 1.4) == 0 && in_box(p, 0.8) == no_region ? no_region : in_box(p, 2);
  });
  EXPECT_GT(counts[0], 50);
  EXPECT_GT(counts[1], 50);
}

TEST(BlockRegions, are_right_in_two_regions_and_outside) {
  const surfaces::Surface nested = surfaces::nested_cubes(8);
  const auto counts = expect_regions(nested, fields::uniform(0.05),
                                     [](Vec3 p) { return in_box(p, 0.5) == 0 ? 1 : in_box(p, 1); });
  for (const int count : counts) EXPECT_GT(count, 50);
}

TEST(BlockRegions, are_right_in_regions_side_by_side_around_a_tunnel) {
  // A bar of 3 x 3 x 2 cells with a tunnel along z; its two halves are two regions.
  const auto region = [](int i, int j, int k) { return i == 1 && j == 1 ? no_region : k; };
  const std::array<int, 3> n{3, 3, 2};
  const auto surface = surfaces::voxels(n, region, surfaces::onto({-1.5, -1.5, -1}, {1.5, 1.5, 1}, n));
  const auto counts = expect_regions(surface, fields::uniform(0.08), [&](Vec3 p) {
    const Vec3 g{std::floor(p.x + 1.5), std::floor(p.y + 1.5), std::floor(p.z + 1)};
    if (g.x < 0 || g.x > 2 || g.y < 0 || g.y > 2 || g.z < 0 || g.z > 1) return no_region;
    return region(int(g.x), int(g.y), int(g.z));
  });
  for (const int count : counts) EXPECT_GT(count, 20);
}

TEST(BlockRegions, are_right_where_sizes_change_around_a_ball) {
  const auto counts = expect_regions(surfaces::cube_with_ball(6, 8), fields::around_unit_sphere(0.08, 0.5),
                                     [](Vec3 p) { return norm(p) < 1 ? no_region : in_box(p, 2); });
  for (const int count : counts) EXPECT_GT(count, 30);
}

/// Without one of its walls a cube's blocks inside and outside become one set, and what is seen from its ends
/// differs.
TEST(BlockRegions, contradict_each_other_where_the_surface_has_a_gap_on_every_rank_alike) {
  const Communicator world = Communicator::world();
  for (int wall = 0; wall < 6; ++wall) {
    const int axis = wall / 2;
    surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 6);
    for (std::size_t t = surface.triangles.size(); t-- > 0;) {
      const auto& v = surface.triangles[t];
      const auto is_on_wall = [&](auto w) { return surface.points[w][axis] == (wall % 2 ? 1 : -1); };
      if (!std::all_of(v.begin(), v.end(), is_on_wall)) continue;
      surface.triangles.erase(surface.triangles.begin() + static_cast<std::ptrdiff_t>(t));
      surface.face.erase(surface.face.begin() + static_cast<std::ptrdiff_t>(t));
    }
    const Problem problem(world, surface, fields::uniform(0.08));
    GrownLattice lattice(problem, {{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}});
    const Surroundings around(lattice);
    const auto& contradiction = around.found.contradiction;
    ASSERT_TRUE(contradiction) << "the missing wall " << wall << " went unnoticed";
    EXPECT_NE(contradiction->seen, contradiction->elsewhere);
    const bool has_triangle =
        std::any_of(around.triangles.begin(), around.triangles.end(), [&](const SurfaceTriangle& t) {
          return t.number == contradiction->triangle && distance(t.points[0], contradiction->place) < 0.8;
        });
    EXPECT_GT(world.sum(std::int64_t{has_triangle}), 0);
    const auto all = world.all_gather(
        parallel::to_wire(std::tie(contradiction->place, contradiction->triangle, contradiction->seen)));
    for (const parallel::Bytes& other : all) EXPECT_EQ(other, all.front());
  }
}

}  // namespace
}  // namespace aeroloom::volume
