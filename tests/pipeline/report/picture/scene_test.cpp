#include "pipeline/report/picture/scene.hpp"

#include "tests/pipeline/report/picture/surfaces.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::picture {
namespace {

using mesh::PatchType;
using parallel::Communicator;

/// Triangles that are shown, and those that are not.
struct Counts {
  std::int64_t shown = 0, hidden = 0;
};
Counts counts_of(const Communicator& world, const Scene& scene) {
  Counts mine;
  for (const auto& of_piece : scene.shown) {
    mine.shown += std::count(of_piece.begin(), of_piece.end(), 1);
    mine.hidden += std::count(of_piece.begin(), of_piece.end(), 0);
  }
  return {world.sum(mine.shown), world.sum(mine.hidden)};
}

TEST(Scene, IsTheBodyWhereTheFarFieldHasAType) {
  const Communicator world = Communicator::world();
  const Scene scene = find_scene(examples::wing_in_box(world), {PatchType::farfield, PatchType::wall});
  EXPECT_TRUE(scene.has_body);
  EXPECT_EQ(scene.patches, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_NEAR(scene.box.low.x, -1, 1e-12);
  EXPECT_NEAR(scene.box.high.y, 2, 1e-12);
  EXPECT_NEAR(scene.domain.high.x, 7, 1e-12);
  EXPECT_LT(norm(scene.open_towards), 1e-9);
  EXPECT_EQ(counts_of(world, scene).shown, 2 * 2 * 40 * 48);
  EXPECT_EQ(counts_of(world, scene).hidden, 6 * 2 * 36);
}

TEST(Scene, IsTheBodyWhereTheFarFieldIsKnownByItsShapeAlone) {
  const Communicator world = Communicator::world();
  const Scene scene = find_scene(examples::wing_in_box(world), {});
  EXPECT_TRUE(scene.has_body);
  EXPECT_EQ(scene.patches, (std::vector<std::uint8_t>{0, 1}));
}

TEST(Scene, IsAllWallsOfABox) {
  const Communicator world = Communicator::world();
  const Scene scene = find_scene(examples::plain_box(world), {});
  EXPECT_FALSE(scene.has_body);
  EXPECT_EQ(counts_of(world, scene).hidden, 0);
}

/// A quarter of a ring of square section: its outer wall lies on the convex hull, its inner one does not.
TEST(Scene, IsAllWallsOfABend) {
  const Communicator world = Communicator::world();
  examples::SurfaceBuilder builder;
  const auto place = [](double radius, double angle, double z) {
    return geometry::Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
  };
  constexpr double quarter = M_PI / 2;
  builder.add_grid(
      12, 4, [&](double s, double t) { return place(3, quarter * s, t); }, 0);
  builder.add_grid(
      4, 12, [&](double s, double t) { return place(2, quarter * t, s); }, 0);
  builder.add_grid(
      4, 12, [&](double s, double t) { return place(2 + s, quarter * t, 1); }, 0);
  builder.add_grid(
      12, 4, [&](double s, double t) { return place(2 + t, quarter * s, 0); }, 0);
  builder.add_grid(
      4, 4, [&](double s, double t) { return place(2 + s, 0, t); }, 0);
  builder.add_grid(
      4, 4, [&](double s, double t) { return place(2 + t, quarter, s); }, 0);
  const Scene scene = find_scene(builder.distribute(world, {"bend"}), {});
  EXPECT_FALSE(scene.has_body);
  EXPECT_EQ(counts_of(world, scene).hidden, 0);
}

TEST(Scene, HalfABodyIsOpenTowardsItsPlane) {
  const Communicator world = Communicator::world();
  examples::SurfaceBuilder builder;
  builder.add_box({-4, 0, -4}, {4, 8, 4}, 4, true, 0);
  builder.add_grid(
      16, 8,
      [](double s, double t) {
        const double polar = M_PI * s, around = M_PI * t;
        return geometry::Vec3{std::cos(polar), std::sin(polar) * std::sin(around),
                              std::sin(polar) * std::cos(around)};
      },
      1);
  const Scene scene =
      find_scene(builder.distribute(world, {"far", "half"}), {PatchType::farfield, PatchType::wall});
  EXPECT_NEAR(scene.open_towards.y, 0.5, 0.02);
  EXPECT_NEAR(scene.open_towards.x, 0, 1e-9);
}

}  // namespace
}  // namespace aeroloom::picture
