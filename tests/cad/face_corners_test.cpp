#include "cad/model/evaluation/face_corners.hpp"

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using shapes::prepare_fluid;
using shapes::prism;

double tangent(double degrees) {
  return std::tan(degrees * std::numbers::pi / 180);
}

/// The angles (degrees) of all corners of the faces with that many edges, ascending.
std::vector<double> angles_of(const Model& model, std::size_t edges, double reach) {
  std::vector<double> angles;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (model.face(f).loops.front().size() != edges) continue;
    for (const FaceCorner& corner : corners_of(model, f)) {
      EXPECT_EQ(corner.face, f);
      if (const auto opening = open_corner(model, corner, reach)) angles.push_back(opening->degrees);
    }
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

TEST(FaceCorners, OpenAsTheirEdgesDo) {
  const Model model = prepare_fluid(prism({{0, 0}, {4, 0}, {4, 4 * tangent(10)}}, 2)).model;
  const std::vector<double> angles = angles_of(model, 3, 0.3);
  ASSERT_EQ(angles.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(angles[i], (std::vector<double>{10, 80, 90})[i / 2], 1e-9);
  // The short side is 0.705 long: only the corner between the long ones opens at 1.5.
  EXPECT_EQ(angles_of(model, 3, 1.5).size(), 2u);
  EXPECT_TRUE(angles_of(model, 3, 2.5).empty());
}

TEST(FaceCorners, MeasureTheWidthAtEqualDistances) {
  const Model model = prepare_fluid(prism({{0, 0}, {4, 0}, {4, 4 * tangent(10)}}, 2)).model;
  int sharp = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    for (const FaceCorner& corner : corners_of(model, f)) {
      const auto opening = open_corner(model, corner, 1.25);
      if (!opening || opening->degrees > 20) continue;
      ++sharp;
      EXPECT_NEAR(opening->width, 2 * 1.25 * std::sin(5 * std::numbers::pi / 180), 1e-9);
      for (int i = 0; i < 2; ++i) {
        const EdgeEnd end =
            i == 0 ? end_at_corner(corner.arriving, false) : end_at_corner(corner.leaving, true);
        EXPECT_NEAR(distance(opening->points[i], model.vertex(corner.vertex)), 1.25, 1e-9);
        EXPECT_NEAR(distance(opening->points[i], model.edge_point(end.edge, opening->parameters[i])), 0,
                    1e-12);
      }
    }
  }
  EXPECT_EQ(sharp, 2);
}

TEST(FaceCorners, ReflexCornersDoNotOpen) {
  const Model model = prepare_fluid(prism({{0, 0}, {3, 0}, {3, 1}, {1.5, 0.2}, {0, 1}}, 2)).model;
  EXPECT_EQ(angles_of(model, 5, 0.05).size(), 2 * 4u);
}

TEST(FaceCorners, SeamsHaveNone) {
  const Model model = prepare_fluid(BRepPrimAPI_MakeCylinder(1, 2).Shape()).model;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    for (const FaceCorner& corner : corners_of(model, f))
      EXPECT_EQ(corner.arriving.edge, corner.leaving.edge);
  }
}

TEST(FaceCorners, ParametersReachHalfAnEdge) {
  const Model model = prepare_fluid(prism({{0, 0}, {4, 0}, {4, 3}}, 2)).model;
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const Edge& edge = model.edge(e);
    const double length = distance(model.vertex(edge.first), model.vertex(edge.last));
    for (const bool first : {true, false}) {
      const auto near = parameter_at(model, {e, first}, 0.49 * length);
      ASSERT_TRUE(near.has_value());
      EXPECT_NEAR(distance(model.edge_point(e, *near), model.vertex(first ? edge.first : edge.last)),
                  0.49 * length, 1e-9);
      EXPECT_FALSE(parameter_at(model, {e, first}, 0.51 * length).has_value());
    }
  }
}

}  // namespace
}  // namespace aeroloom::cad
