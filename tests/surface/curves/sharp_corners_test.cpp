/// One triangle fills a sharp corner of a face, and the elements behind it are as good as elsewhere.
#include "surface/curves/sharp_corners.hpp"

#include "mesh/quality/quality.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"
#include "tests/surface/face_fixture.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;

constexpr double sharp_degrees = 16;

/// A right triangle whose corner at the origin is sharp, drawn out along y.
Model sharp_prism(double degrees = sharp_degrees) {
  const double height = 3 * std::tan(degrees * std::numbers::pi / 180);
  return cad::shapes::prepare_fluid(cad::shapes::prism({{0, 0}, {3, 0}, {3, height}}, 1)).model;
}

sizing::SizeField field_of(const Model& model) {
  return sizing::build_size_field(parallel::Communicator::world(), model, {0.05, 0.2, 12, 1.3, 0});
}

TEST(SharpCorners, AreFoundWithEqualLegs) {
  const Model model = sharp_prism();
  const sizing::SizeField field = field_of(model);
  const auto corners = find_sharp_corners(model, field);
  ASSERT_EQ(corners.size(), 2u);
  const CurveMesh curves = discretise_curves(model, field);
  for (const SharpCorner& corner : corners) {
    EXPECT_NEAR(corner.degrees, sharp_degrees, 1e-6);
    EXPECT_GT(corner.leg, 0.05);
    EXPECT_LT(corner.leg, 0.3);
    const Vec3 vertex = model.vertex(corner.vertex);
    for (const cad::EdgeEnd& end : corner.ends) {
      const auto chain = curves.chain(model, end.edge);
      const CurveVertex second = end.first ? chain[1] : chain[chain.size() - 2];
      EXPECT_NEAR(distance(curves.points[second], vertex), corner.leg, 1e-9);
    }
  }
}

TEST(SharpCorners, HoldOneTriangle) {
  const Model model = sharp_prism();
  const auto communicator = parallel::Communicator::world();
  const SurfaceMesh surface = mesh_surface(model, field_of(model), {});
  ASSERT_EQ(surface.report.sharp_corners.size(), 2u);
  std::int64_t below_corner = 0, below_twenty = 0;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const double degrees = mesh::smallest_angle(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]));
      below_corner += degrees < sharp_degrees - 1e-3;
      below_twenty += degrees < 20;
    }
  }
  EXPECT_EQ(communicator.sum(below_corner), 0);
  EXPECT_EQ(communicator.sum(below_twenty), 2);
  for (const ListedCorner& corner : surface.report.sharp_corners) {
    EXPECT_NEAR(corner.degrees, sharp_degrees, 1e-6);
    EXPECT_LT(std::hypot(corner.point.x, corner.point.z), 1e-9);
  }
}

// The faces beyond its two edges meet in the edge of the wedge: they cannot become neighbours in another.
TEST(SharpCorners, OfAWedgesSectionStayOpen) {
  const Model model = sharp_prism(6);
  const sizing::SizeField field = field_of(model);
  const auto corners = find_sharp_corners(model, field);
  ASSERT_EQ(corners.size(), 2u);
  for (const SharpCorner& corner : corners) {
    EXPECT_FALSE(corner.closes);
    EXPECT_GT(corner.leg, 0);
  }
  EXPECT_TRUE(mesh_surface(model, field, {}).report.closed_cusps.empty());
}

}  // namespace
}  // namespace aeroloom::surface
