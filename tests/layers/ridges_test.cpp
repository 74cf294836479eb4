#include "layers/ridges.hpp"

#include "layers/vertex_fans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

constexpr std::int32_t top_face = 1, side_face = 2, plane_face = 3;

StarTriangle triangle(std::int32_t number, Vec3 next, Vec3 previous, WallRole role, std::int32_t face) {
  return {normalized(cross(next, previous)),
          next,
          previous,
          {0, static_cast<std::uint64_t>(number)},
          {0, static_cast<std::uint64_t>(number) + 1},
          0,
          number,
          static_cast<std::int32_t>(role),
          face,
          0,
          static_cast<std::int32_t>(number == 0 ? EdgeTurn::sharp : EdgeTurn::smooth)};
}

/// The star of the origin, where an edge between a wall above and one beside it leaves the plane y = 0 at
/// this angle, in degrees.
std::vector<StarTriangle> star_on_plane(double angle) {
  const double radians = angle * std::numbers::pi / 180;
  const std::array<Vec3, 5> spokes{
      {{std::cos(radians), std::sin(radians), 0}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, -1}}};
  std::vector<StarTriangle> star;
  for (std::int32_t i = 0; i < 5; ++i) {
    const bool is_wall = i == 0 || i == 4;
    star.push_back(triangle(i, spokes[i], spokes[(i + 1) % 5], is_wall ? WallRole::layered : WallRole::plane,
                            i == 0   ? top_face
                            : i == 4 ? side_face
                                     : plane_face));
  }
  star[4].previous = star[0].next;
  return star;
}

/// The star of the origin, on an edge along z in the plane y = 0 from which a wall goes on to a place. The
/// fluid has y > 0.
std::vector<StarTriangle> star_along_plane(Vec3 wall) {
  const std::array<Vec3, 4> spokes{{{0, 0, -1}, wall, {0, 0, 1}, {1, 0, 0}}};
  std::vector<StarTriangle> star;
  for (std::int32_t i = 0; i < 4; ++i) {
    star.push_back(triangle(i, spokes[i], spokes[(i + 1) % 4], i < 2 ? WallRole::layered : WallRole::plane,
                            i < 2 ? side_face : plane_face));
    star.back().edge_turn = static_cast<std::int32_t>(i % 2 == 0 ? EdgeTurn::sharp : EdgeTurn::smooth);
  }
  star[3].previous = star[0].next;
  return star;
}

TEST(RidgesLocal, LieInPlanesWhereAWallTurnsIntoItsMirrorImage) {
  std::vector<RidgeSide> sides;
  const Vec3 out_of_fluid{0, -1, 0};
  const std::optional<Ridge> ridge =
      find_ridge({{}, EdgeTurn::sharp, out_of_fluid}, star_along_plane({-1, 0.1, 0}), sides);
  ASSERT_TRUE(ridge);
  ASSERT_EQ(ridge->half_side, 1);
  EXPECT_EQ(sides, (std::vector<RidgeSide>{0, 0, 1, 1}));
  EXPECT_NEAR(ridge->turns[0].angle, std::atan(10), 1e-12);
  const std::array<std::int32_t, 2> sectors{3, 3};
  const std::optional<VertexFan> fan = make_vertex_fan(*ridge, sectors);
  ASSERT_TRUE(fan);
  EXPECT_EQ(fan->directions.size(), 4U);
  EXPECT_NEAR(norm(fan->directions[fan->of_side[0]] - normalized(Vec3{0.1, 1, 0})), 0, 1e-12);
  EXPECT_NEAR(norm(fan->directions[fan->of_side[1]] - Vec3{1, 0, 0}), 0, 1e-12);
  std::vector<StarTriangle> ends_here = star_along_plane({-1, 0.1, 0});
  ends_here[2].edge_turn = static_cast<std::int32_t>(EdgeTurn::smooth);
  EXPECT_FALSE(find_ridge({{}, EdgeTurn::sharp, out_of_fluid}, ends_here, sides));
  for (const Vec3 none : {Vec3{0, 1, 0}, Vec3{0.5, 1, 0}})
    EXPECT_FALSE(find_ridge({{}, EdgeTurn::sharp, out_of_fluid}, star_along_plane(none), sides));
}

TEST(RidgesLocal, EndOnPlanesThatTheyMeetObliquely) {
  for (const double angle : {90.0, 60.0, 29.0, 14.0}) {
    std::vector<RidgeSide> sides;
    const std::optional<Ridge> ridge =
        find_ridge({{}, EdgeTurn::sharp, {0, 1, 0}}, star_on_plane(angle), sides);
    ASSERT_TRUE(ridge) << angle;
    const std::array<std::int32_t, 1> sectors{3};
    const std::optional<VertexFan> fan = make_vertex_fan(*ridge, sectors);
    ASSERT_TRUE(fan) << angle;
    for (const Vec3 column : fan->directions) {
      EXPECT_NEAR(column.y, 0, 1e-12) << angle;
      EXPECT_LT(norm(column), 2 + 1e-9) << angle;
    }
    const double stretched = std::min(2.0, 1 / std::sin(angle * std::numbers::pi / 180));
    EXPECT_NEAR(norm(fan->directions[0] - Vec3{0, 0, 1}), 0, 1e-12) << angle;
    EXPECT_NEAR(norm(fan->directions.back() - Vec3{stretched, 0, 0}), 0, 1e-12) << angle;
  }
  std::vector<RidgeSide> sides;
  EXPECT_FALSE(find_ridge({{}, EdgeTurn::sharp, {0, 1, 0}}, star_on_plane(1), sides));
}

// The diagonal of a strip between two sharp edges of the CAD.
TEST(RidgesLocal, AreNotWithinAFaceThatTurnsLittle) {
  std::vector<StarTriangle> star = star_on_plane(90);
  star[0] = triangle(0, {0, 1, 0}, {-1, 0, -0.1}, WallRole::layered, top_face);
  star[4] = triangle(4, {1, 0, -0.1}, {0, 1, 0}, WallRole::layered, top_face);
  const std::vector<StarTriangle> bent{star[0], star[4]};
  std::vector<RidgeSide> sides;
  const auto ridge_at = [&](std::int32_t face) {
    std::vector<StarTriangle> each = bent;
    each[1].face = face;
    return find_ridge({{}, EdgeTurn::sharp, {}}, each, sides).has_value();
  };
  EXPECT_TRUE(ridge_at(side_face));
  EXPECT_FALSE(ridge_at(top_face));
}

}  // namespace
}  // namespace aeroloom::layers
