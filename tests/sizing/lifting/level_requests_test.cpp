#include "sizing/lifting/level_requests.hpp"

#include "cad/domain/domain.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

TEST(LevelDemands, LinesHaveSourcesCloserThanTheirSizes) {
  const RootCube root(geometry::Box{{0, 0, 0}, {8, 8, 8}});
  const SizeLine line{{{1, 1, 1}, {3, 1, 1}, {3, 4, 1}}, {0.1, 0.2, 0.2}};
  for (const double coarsening : {1.0, 4.0}) {
    const std::vector<SizeSource> sources = sources_along(root, line, coarsening);
    EXPECT_LE(static_cast<double>(sources.size()), points_along(line, coarsening));
    for (double x = 1; x < 3; x += 0.01) {
      double least = 1e300;
      for (const SizeSource& source : sources) least = std::min(least, distance(source.point, Vec3{x, 1, 1}));
      EXPECT_LT(least, 0.2 * coarsening);
    }
    for (const SizeSource& source : sources) {
      const double expected = coarsening * (source.point.y > 1 ? 0.2 : 0.1 + 0.05 * (source.point.x - 1));
      EXPECT_NEAR(source.size, expected, 1e-12);
    }
  }
}

/// The field of the built-in aircraft's sizes along edges, at places of them.
TEST(LevelDemands, FieldHasTheSpacingAlongEdges) {
  cad::DomainOptions options;
  options.transport = cad::TransportDimensions{};
  options.default_far_field.extent = 100;
  options.default_far_field.unit = cad::ExtentUnit::semispan;
  options.default_far_field.symmetry = cad::Symmetry::y;
  const cad::Model model = cad::prepare_domain(options).model;
  FieldFactory factory(SampledModel(parallel::Communicator::world(), model), {0}, Fields::one);
  const Vec3 flow{1, 0, 0};
  const LiftingBodies bodies = find_lifting_bodies(factory.sampled(), flow);
  EXPECT_NEAR(model.bounds().size().x, 2 * 100 * bodies.semispan, 0.01 * bodies.semispan);
  const LevelSizes level = sizes_of(Level::a);
  GivenSizes given = level_bounds(model, bodies, level);
  EXPECT_DOUBLE_EQ(*given.surface_maximum, level.body * bodies.reference_chord);
  // Sizes that grow quickly, so that the field is small.
  given.growth = 2.5, given.curvature_angle = 60, given.surface_maximum = 1;
  factory.request_lines(level_lines(model, bodies, level, flow));
  const SizeField field = factory.build_field(with_given({}, given));
  for (const LiftingElement& element : bodies.elements) {
    for (const LiftingStation& station : element.stations) {
      const double size = level.edge * station.chord;
      EXPECT_LE(field(station.leading), 1.1 * size);
      EXPECT_GE(field(station.leading), 0.5 * size);
      EXPECT_LE(field(station.trailing), 1.1 * size);
    }
    const LiftingStation& middle = element.stations[element.stations.size() / 2];
    EXPECT_LE(field(middle.trailing + 1.5 * middle.chord * flow), 1.5 * level.body * middle.chord);
    EXPECT_GT(field(middle.trailing + 3 * middle.chord * flow), 3 * level.body * middle.chord);
  }
}

}  // namespace
}  // namespace aeroloom::sizing
