#include "layers/front.hpp"

#include "layers/good_columns.hpp"
#include "mesh/checks/intersection.hpp"
#include "tests/meshes/wall_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using parallel::Communicator;

/// Two plates with a slit between that is narrower than layers from both sides.
examples::Shapes narrow_slit() {
  return examples::Shapes()
      .add_box({-5, -5, -5}, {7, 7, 7}, {4, 4, 4}, examples::Fluid::inside)
      .add_box({0, 0, -0.7}, {2, 2, -0.2}, {8, 8, 2}, examples::Fluid::outside)
      .add_box({0, 0, 0}, {2, 2, 0.5}, {8, 8, 2}, examples::Fluid::outside);
}

LayerOptions layers_on_plates() {
  LayerOptions options;
  options.patches.resize(3);
  options.patches[1].first = options.patches[2].first = 1e-3;
  return options;
}

/// Columns of a wall that nobody has told of gaps.
struct Unaware {
  Unaware(const mesh::DistributedMesh& mesh)
      : wall(mesh, layers_on_plates()),
        fans(gather_fans(wall)),
        directions(find_directions(wall, fans)),
        limits(wall, layers_on_plates(), fans, directions) {
    limits.converge();
    shrink_to_good(wall, directions, limits);
  }
  mesh::DistributedMesh front() const {
    return make_front(wall.mesh, make_columns(wall, directions, limits));
  }

  WallShare wall;
  Fans fans;
  Directions directions;
  ColumnLimits limits;
};

mesh::DistributedMesh clear(Unaware& columns, LayerReport& report) {
  const PlaneRemesher none;
  return FrontClearing(columns.wall, columns.directions, none).run(columns.limits, report);
}

TEST(Front, ShrinksUntilNoTrianglesMeet) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = narrow_slit().distribute(world, 5);
  Unaware columns(mesh);
  EXPECT_FALSE(mesh::find_intersections(columns.front()).empty());
  LayerReport report;
  clear(columns, report);
  EXPECT_TRUE(mesh::find_intersections(columns.front()).empty());
  EXPECT_GE(report.crossing_rounds, 1);
  EXPECT_GT(report.crossings, 0);
  EXPECT_EQ(report.zeroed_by_force, 0);
  std::int64_t crossing = 0, live = 0;
  for (std::int32_t v = 0; v < columns.wall.vertex_count(); ++v) {
    crossing += columns.limits.cause(v) == LayerLimit::crossing;
    live += columns.limits.count(v) > 0;
  }
  EXPECT_GT(world.sum(crossing), 0);
  EXPECT_GT(world.sum(live), 100);
}

TEST(Front, IsTheSameAfterCrossingsOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  const auto cleared = [](const Communicator& communicator) {
    const mesh::DistributedMesh mesh = narrow_slit().distribute(communicator, 5);
    Unaware columns(mesh);
    LayerReport report;
    const mesh::DistributedMesh front = clear(columns, report);
    return mesh::hash_mesh(front, mesh::number_mesh(front));
  };
  EXPECT_EQ(cleared(world), cleared(self));
}

/// A plate whose layers reach over a ball, smaller than a triangle of the plate, without touching it.
examples::Shapes plate_below_ball() {
  return examples::Shapes()
      .add_box({-5, -5, -5}, {7, 7, 7}, {4, 4, 4}, examples::Fluid::inside)
      .add_box({0, 0, 0}, {2, 2, 0.5}, {4, 4, 1}, examples::Fluid::outside)
      .add_sphere({0.6, 0.7, 0.55}, 0.02, 2, examples::Fluid::outside);
}

TEST(Front, DoesNotCloseAroundAPart) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = plate_below_ball().distribute(world, 5);
  LayerOptions options;
  options.patches.resize(3);
  options.patches[1].first = 1e-2;
  WallShare wall(mesh, options);
  const Fans fans = gather_fans(wall);
  const Directions directions = find_directions(wall, fans);
  ColumnLimits limits(wall, options, fans, directions);
  limits.converge();
  shrink_to_good(wall, directions, limits);
  LayerReport report;
  const PlaneRemesher none;
  const mesh::DistributedMesh before = make_front(wall.mesh, make_columns(wall, directions, limits));
  EXPECT_TRUE(mesh::find_intersections(before).empty());
  FrontClearing(wall, directions, none).run(limits, report);
  EXPECT_GT(report.swallowing, 0);
  double least = 1;
  std::int64_t live = 0;
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    if (distance(wall.points[v], {0.5, 0.5, 0.5}) < 0.1) least = std::min(least, limits.total(v));
    live += limits.count(v) > 0;
  }
  EXPECT_LT(world.minimum(least), 0.05);
  EXPECT_GT(world.sum(live), 10);
}

TEST(Front, LeavesCrossingsOfTheWallItself) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh =
      examples::Shapes()
          .add_box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, examples::Fluid::outside)
          .add_box({0.5, 0.3, 0.2}, {1.6, 1.5, 1.4}, {2, 2, 2}, examples::Fluid::outside)
          .distribute(world, 3);
  WallShare wall(mesh, {});
  const Fans fans = gather_fans(wall);
  const Directions directions = find_directions(wall, fans);
  ColumnLimits limits(wall, {}, fans, directions);
  LayerReport report;
  const PlaneRemesher none;
  FrontClearing(wall, directions, none).run(limits, report);
  EXPECT_EQ(report.crossing_rounds, 0);
}

}  // namespace
}  // namespace aeroloom::layers
