// Blunt trailing edges closed on request: the mesh ends in the curve, and is the same on any number of ranks.
#include "tests/cad/blunt_shapes.hpp"
#include "tests/pipeline/cad_cases.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;

constexpr double thickness = 0.01;

report::RunRecord run_wing(const TopoDS_Shape& wing, cad::TrailingEdges treatment) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(wing, "wing.brep"), folder, 30000);
  input.domain.trailing_edges.treatment = treatment;
  input.domain.far_field = cad::FarFieldOptions{};
  input.domain.far_field->extent = 3;
  input.domain.far_field->symmetry = cad::Symmetry::y;
  // Elements several times as large as the strip is wide, on both bodies alike.
  input.sizing.minimum = input.sizing.feature_minimum = 0.06;
  input.sizing.maximum = 2;
  std::string alone;
  report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  return record;
}

TEST(SharpEdges, HalfWingWithAKinkAndASharpTip) {
  const TopoDS_Shape wing =
      cad::shapes::blunt_wing({{0, 0, thickness}, {1, 0.1, thickness}, {2, 0.5, thickness}, {3, 0.9, 0}});
  const report::RunRecord blunt = run_wing(wing, cad::TrailingEdges::keep);
  const report::RunRecord sharp = run_wing(wing, cad::TrailingEdges::sharpen);
  const auto closed = cad::shapes::changes_about(sharp.domain.changes, "was closed to a curve");
  if (parallel::Communicator::world().is_root()) {
    EXPECT_EQ(closed.size(), 3u);
  }
  EXPECT_EQ(blunt.faces, sharp.faces + 3);
  // Strips take flat elements where they are not resolved; a closed edge does not.
  EXPECT_LT(blunt.quality->min_dihedral.minimum, 0.7 * sharp.quality->min_dihedral.minimum);
  EXPECT_GT(sharp.quality->min_dihedral.minimum, 15);
}

}  // namespace
}  // namespace aeroloom::pipeline
