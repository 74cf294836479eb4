#include "pipeline/edge_turns.hpp"

#include "tests/cad/primitives.hpp"
#include "tests/wall_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using layers::EdgeTurn;

std::ptrdiff_t count(const std::vector<EdgeTurn>& turns, EdgeTurn turn) {
  return std::count(turns.begin(), turns.end(), turn);
}

TEST(EdgeTurnsLocal, AreSharpAtABox) {
  const auto turns = find_edge_turns(cad::make_primitive_domain(cad::PrimitiveKind::box));
  EXPECT_EQ(turns.size(), 12U);
  EXPECT_EQ(count(turns, EdgeTurn::sharp), 12);
}

// On a plane of symmetry all four walls around it are at right angles to it.
TEST(EdgeTurnsLocal, AreThoseIntoTheMirrorImageAtPlanes) {
  const auto turns = find_edge_turns(cad::make_primitive_domain(cad::PrimitiveKind::box), {0});
  EXPECT_EQ(count(turns, EdgeTurn::upright), 4);
  EXPECT_EQ(count(turns, EdgeTurn::sharp), 8);
}

// Two circles, and the seam of the side.
TEST(EdgeTurnsLocal, AreSmoothAtASeam) {
  const auto turns = find_edge_turns(cad::make_primitive_domain(cad::PrimitiveKind::cylinder));
  EXPECT_EQ(count(turns, EdgeTurn::sharp), 2);
  EXPECT_EQ(count(turns, EdgeTurn::smooth), static_cast<std::ptrdiff_t>(turns.size()) - 2);
  EXPECT_GE(count(turns, EdgeTurn::smooth), 1);
}

// Its edges are concave seen from the fluid.
TEST(EdgeTurnsLocal, AreNoRidgesInABoxOfFluid) {
  const std::vector<double> inside = find_ridge_turns(cad::make_primitive_domain(cad::PrimitiveKind::box));
  EXPECT_EQ(std::count(inside.begin(), inside.end(), 0), 12);
}

// Half a diamond on a plane of symmetry: both of its ends in the plane turn by a quarter circle less half
// their angle, its top by too little.
TEST(EdgeTurnsLocal, AreHalfOfThoseIntoTheMirrorImageAtPlanes) {
  const cad::Model model = shapes::prism({{-4, 0}, {-1, 0}, {0, 0.2}, {1, 0}, {4, 0}, {4, 3}, {-4, 3}});
  std::vector<cad::FaceId> planes;
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    const cad::Coedge& use = model.face(face).loops.front().front();
    const auto frame = model.face_frame(face, model.edge_uv(face, use, model.edge(use.edge).first_parameter));
    if (std::abs(frame.normal.y) > 0.999 && std::abs(frame.point.y) < 1e-9) planes.push_back(face);
  }
  ASSERT_EQ(planes.size(), 2U);
  std::vector<double> turns = find_ridge_turns(model, planes);
  std::sort(turns.rbegin(), turns.rend());
  const double expected = std::numbers::pi / 2 - std::atan(0.2);
  EXPECT_NEAR(turns[0], expected, 1e-9);
  EXPECT_NEAR(turns[1], expected, 1e-9);
  EXPECT_EQ(turns[2], 0);
}

}  // namespace
}  // namespace aeroloom::pipeline
