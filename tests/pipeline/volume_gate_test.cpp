/// Gates of finished meshes: regions and walls are what they are in the CAD, or a few elements wide; a mesh
/// is valid.
#include "pipeline/finished_volume.hpp"
#include "pipeline/report/exit_code.hpp"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

report::RunRecord with_region(double volume, double cad_volume) {
  report::RunRecord record;
  record.quality = mesh::QualitySummary{};
  record.sizes.minimum = 0.1;
  record.regions_filled.push_back({.name = "tank", .volume = volume, .cad_volume = cad_volume});
  return record;
}

/// Refers to the record.
JudgedMesh judged(const report::RunRecord& record) {
  return {record, record.patches, nullptr, record.sizes, record.unit};
}

TEST(VolumeGate, RefusesRegionsOfAnotherVolume) {
  const cases::Case input;
  EXPECT_NO_THROW(require_quality(input, judged(with_region(0.95, 1))));
  EXPECT_THROW(require_quality(input, judged(with_region(0.85, 1))), report::StageFailure);
  EXPECT_TRUE(coarse_region(input.gate, judged(with_region(0.85, 1))).empty());
}

TEST(VolumeGate, WarnsOfRegionsAFewElementsWide) {
  const cases::Case input;
  const double few = 0.2 * 0.2 * 0.2;
  EXPECT_NO_THROW(require_quality(input, judged(with_region(0.85 * few, few))));
  EXPECT_NE(coarse_region(input.gate, judged(with_region(0.85 * few, few))).find("'tank'"),
            std::string::npos);
  EXPECT_TRUE(coarse_region(input.gate, judged(with_region(0.95 * few, few))).empty());
  EXPECT_THROW(require_quality(input, judged(with_region(0.7 * few, few))), report::StageFailure);
}

/// The message of the gate; empty where the mesh passes.
std::string refusal(const cases::Case& input, const report::RunRecord& record) {
  try {
    require_quality(input, judged(record));
    return {};
  } catch (const report::StageFailure& failure) {
    EXPECT_EQ(failure.code(), report::ExitCode::quality_gate);
    EXPECT_EQ(failure.stage(), "quality gate");
    return failure.what();
  }
}

report::RunRecord with_walls(double area, double cad_area) {
  report::RunRecord record = with_region(1, 1);
  record.unit = "mm";
  record.patches.push_back({.name = "whole", .area = 50, .cad_area = 50});
  record.patches.push_back({.name = "missed", .area = area, .cad_area = cad_area});
  return record;
}

TEST(AreaGate, RefusesWallsOfAnotherArea) {
  const cases::Case input;
  EXPECT_EQ(refusal(input, with_walls(46, 50)), "");
  const std::string text = refusal(input, with_walls(35, 50));
  EXPECT_NE(text.find("improve.gate.area_deviation is 0.15"), std::string::npos) << text;
  EXPECT_NE(text.find("most is missed on 'missed'"), std::string::npos) << text;
  EXPECT_NE(text.find("the unit of the file, which is mm"), std::string::npos) << text;
}

TEST(AreaGate, CountsWallsAlone) {
  report::RunRecord record = with_walls(35, 50);
  record.patches.back().type = mesh::PatchType::farfield;
  EXPECT_EQ(refusal({}, record), "");
}

TEST(QualityGates, AreAllToldTogether) {
  cases::Case input;
  input.gate.smallest_angle = 20;
  report::RunRecord record = with_walls(35, 50);
  record.regions_filled.front().volume = 0.5;
  record.quality->min_dihedral.minimum = 7;
  const std::string text = refusal(input, record);
  for (const char* word :
       {"smallest_angle is 7", "area_deviation is 0.15", "region 'tank' has a volume of 0.5"})
    EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
}

TEST(QualityGates, InvalidMeshesAreToldWithEveryViolation) {
  mesh::ValidityReport report;
  EXPECT_NO_THROW(require_valid("the volume mesh", report));
  report.violations = {"one", "two"};
  try {
    require_valid("the volume mesh", report);
    ADD_FAILURE() << "taken";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the volume mesh is not valid:\n  one\n  two");
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
