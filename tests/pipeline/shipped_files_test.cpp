// The CAD files of tests/data, from file to mesh: what outsiders have who have no other geometry.
#include "tests/cad/blunt_shapes.hpp"
#include "tests/pipeline/cad_cases.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;

cases::Case case_on(const char* name, const Folder& folder, double minimum, double maximum) {
  cases::Case input = cad_cases::coarse_case(source_tree() / "tests" / "data" / name, folder, 20000);
  input.sizing.minimum = minimum;
  input.sizing.maximum = maximum;
  input.sizing.growth = 1.6;
  input.sizing.proximity = 0;
  return input;
}

void expect_area(const report::RunRecord& record, const std::string& patch, double area) {
  const auto found = std::find_if(record.patches.begin(), record.patches.end(),
                                  [&](const report::PatchRow& row) { return row.name == patch; });
  ASSERT_NE(found, record.patches.end());
  EXPECT_NEAR(found->area, area, 0.02 * area);
}

TEST(ShippedFiles, WingBodyInAFarField) {
  const Folder folder;
  cases::Case input = case_on("wing_body.step", folder, 0.1, 4);
  input.sizing.surface_maximum = 0.6;
  input.domain.trailing_edges.treatment = cad::TrailingEdges::sharpen;
  input.domain.far_field = cad::FarFieldOptions{};
  input.domain.far_field->shape = cad::FarFieldShape::box;
  input.domain.far_field->extent = 3;
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_EQ(record.faces, 16) << "six of the far field, ten of twelve of the body";
  if (parallel::Communicator::world().is_root()) {
    EXPECT_EQ(cad::shapes::changes_about(record.domain.changes, "was closed to a curve").size(), 2u);
  }
  expect_area(record, "body", 38.0);
  EXPECT_NEAR(record.mesh_volume, 48.0 * 48 * 48 - 5.6, 1);
  EXPECT_GT(record.quality->min_dihedral.minimum, 20);
}

TEST(ShippedFiles, BracketOfLooseTrimmedFaces) {
  const Folder folder;
  cases::Case input = case_on("bracket.igs", folder, 2, 8);
  input.domain.kind = cad::DomainKind::fluid;
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_EQ(record.faces, 13);
  if (parallel::Communicator::world().is_root()) {
    EXPECT_EQ(cad::shapes::changes_about(record.domain.changes, "sewn").size(), 1u);
  }
  EXPECT_NEAR(record.mesh_volume, 28'240, 0.01 * 28'240);  // two plates, two bores, what was rounded
  EXPECT_GT(record.quality->min_dihedral.minimum, 20);
}

}  // namespace
}  // namespace aeroloom::pipeline
