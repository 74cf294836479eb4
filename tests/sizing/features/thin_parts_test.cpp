// Thin parts of a body, whose inside has no mesh, ask for no more than triangles of both sides need.
#include "sizing/features/proximity.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/wall_bodies.hpp"

#include <cmath>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gtest/gtest.h>

using namespace aeroloom;
using cad::DomainKind;
using cad::Model;
using sizing::SizeField;
using sizing::SizingOptions;

namespace {

constexpr double by_default = SizingOptions{}.proximity;

SizeField build(const Model& model, double proximity, double curvature_angle = 30) {
  SizingOptions options{0.001, 1, curvature_angle, 1.3, 0, proximity};
  options.feature_minimum = options.minimum;
  return sizing::build_size_field(parallel::Communicator::world(), model, options);
}

/// A tube of this radius inside, open at both ends.
Model tube(double thickness, DomainKind kind) {
  return shapes::domain_of(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(1 + thickness, 3).Shape(),
                                           BRepPrimAPI_MakeCylinder(1, 3).Shape())
                               .Shape(),
                           kind);
}

}  // namespace

TEST(ThinParts, PlanarSidesMayBeCoarse) {
  const Model plate =
      shapes::domain_of(BRepPrimAPI_MakeBox(gp_Pnt(-1, -1, 0), 2, 2, 0.02).Shape(), DomainKind::body);
  EXPECT_GT(build(plate, by_default)({0, 0, 0}), 0.2);
  EXPECT_LT(build(plate, 1)({0, 0, 0}), 0.035);
}

TEST(ThinParts, CurvedSidesStayApart) {
  constexpr double thickness = 0.01;
  const Model thin = tube(thickness, DomainKind::body);
  const double kept = std::sqrt(3 * thickness / (1 + 1 / (1 + thickness)));
  EXPECT_NEAR(sizing::size_that_keeps_apart(thickness, 1 + 1 / (1 + thickness)), kept, 1e-12);
  // Curvature alone would ask for half the radius.
  const SizeField field = build(thin, by_default);
  for (const double z : {1.0, 1.5, 2.0}) {
    const double size = field({1.005, 0, z});
    EXPECT_LE(size, 1.25 * kept);
    EXPECT_GE(size, 0.9 * kept);
  }
  EXPECT_GT(build(thin, 0)({1.005, 0, 1.5}), 2 * kept);
}

TEST(ThinParts, GapsKeepOneElement) {
  constexpr double width = 0.04;
  const Model gap = tube(width, DomainKind::fluid);
  const SizeField field = build(gap, by_default);
  EXPECT_EQ(field({1 + width / 2, 0, 1.5}), build(gap, 1)({1 + width / 2, 0, 1.5}));
  EXPECT_LT(field({1 + width / 2, 0, 1.5}), 1.7 * width);
}
