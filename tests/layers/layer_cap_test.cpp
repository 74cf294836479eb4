#include "layers/layer_cap.hpp"

#include "layers/good_columns.hpp"
#include "mesh/checks/intersection.hpp"
#include "tests/layers/directed_wall.hpp"
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
  Unaware(const mesh::DistributedMesh& mesh, const LayerOptions& options)
      : base(mesh, options), limits(examples::limits_of(base, options)) {}

  void shrink() {
    limits.converge();
    shrink_to_good(base.wall, base.fans, base.directions, limits);
  }
  mesh::DistributedMesh cap() const {
    return make_cap(base.wall.mesh, make_columns(base.wall, base.fans, base.directions, limits));
  }
  mesh::DistributedMesh clear(LayerReport& report) {
    const PlaneRemesher none;
    return CapClearing(base.wall, base.fans, base.directions, {none}).run(limits, report);
  }

  examples::DirectedWall base;
  ColumnLimits limits;
};

TEST(LayerCap, ShrinksUntilNoTrianglesMeet) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = narrow_slit().distribute(world, 5);
  Unaware columns(mesh, layers_on_plates());
  columns.shrink();
  EXPECT_FALSE(mesh::find_intersections(columns.cap()).empty());
  LayerReport report;
  columns.clear(report);
  EXPECT_TRUE(mesh::find_intersections(columns.cap()).empty());
  EXPECT_GE(report.crossing_rounds, 1);
  EXPECT_GT(report.crossings, 0);
  EXPECT_EQ(report.zeroed_by_force, 0);
  std::int64_t crossing = 0, live = 0;
  for (std::int32_t v = 0; v < columns.base.wall.vertex_count(); ++v) {
    crossing += columns.limits.cause(v) == LayerLimit::crossing;
    live += columns.limits.count(v) > 0;
  }
  EXPECT_GT(world.sum(crossing), 0);
  EXPECT_GT(world.sum(live), 100);
}

TEST(LayerCap, IsTheSameAfterCrossingsOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  const auto cleared = [](const Communicator& communicator) {
    const mesh::DistributedMesh mesh = narrow_slit().distribute(communicator, 5);
    Unaware columns(mesh, layers_on_plates());
    columns.shrink();
    LayerReport report;
    const mesh::DistributedMesh cap = columns.clear(report);
    return mesh::hash_mesh(mesh::number_mesh(cap));
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

TEST(LayerCap, DoesNotCloseAroundAPart) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = plate_below_ball().distribute(world, 5);
  LayerOptions options;
  options.patches.resize(3);
  options.patches[1].first = 1e-2;
  Unaware columns(mesh, options);
  columns.shrink();
  LayerReport report;
  EXPECT_TRUE(mesh::find_intersections(columns.cap()).empty());
  columns.clear(report);
  EXPECT_GT(report.enclosing, 0);
  double least = 1;
  std::int64_t live = 0;
  for (std::int32_t v = 0; v < columns.base.wall.vertex_count(); ++v) {
    if (distance(columns.base.wall.points[v], {0.5, 0.5, 0.5}) < 0.1)
      least = std::min(least, columns.limits.total(v));
    live += columns.limits.count(v) > 0;
  }
  EXPECT_LT(world.minimum(least), 0.05);
  EXPECT_GT(world.sum(live), 10);
}

TEST(LayerCap, LeavesCrossingsOfTheWallItself) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh =
      examples::Shapes()
          .add_box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, examples::Fluid::outside)
          .add_box({0.5, 0.3, 0.2}, {1.6, 1.5, 1.4}, {2, 2, 2}, examples::Fluid::outside)
          .distribute(world, 3);
  Unaware columns(mesh, {});
  LayerReport report;
  columns.clear(report);
  EXPECT_EQ(report.crossing_rounds, 0);
}

}  // namespace
}  // namespace aeroloom::layers
