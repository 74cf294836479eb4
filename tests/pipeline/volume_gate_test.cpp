/// The gate of volumes: a region is what it is in the CAD, or a few elements wide.
#include "pipeline/finished_volume.hpp"
#include "pipeline/run.hpp"

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

TEST(VolumeGate, RefusesRegionsOfAnotherVolume) {
  const cases::Case input;
  EXPECT_NO_THROW(require_quality(input, with_region(0.95, 1)));
  EXPECT_THROW(require_quality(input, with_region(0.85, 1)), report::StageFailure);
  EXPECT_TRUE(coarse_region(input.gate, with_region(0.85, 1)).empty());
}

TEST(VolumeGate, WarnsOfRegionsAFewElementsWide) {
  const cases::Case input;
  const double few = 0.2 * 0.2 * 0.2;
  EXPECT_NO_THROW(require_quality(input, with_region(0.85 * few, few)));
  EXPECT_NE(coarse_region(input.gate, with_region(0.85 * few, few)).find("'tank'"), std::string::npos);
  EXPECT_TRUE(coarse_region(input.gate, with_region(0.95 * few, few)).empty());
  EXPECT_THROW(require_quality(input, with_region(0.7 * few, few)), report::StageFailure);
}

}  // namespace
}  // namespace aeroloom::pipeline
