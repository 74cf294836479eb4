#include "pipeline/edge_turns.hpp"

#include "tests/cad/primitives.hpp"

#include <algorithm>

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

}  // namespace
}  // namespace aeroloom::pipeline
