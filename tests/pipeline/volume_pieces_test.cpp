// A region in many volume pieces: one mesh, good angles, no trace of the interfaces, whatever the rank count.
#include "tests/pipeline/cad_cases.hpp"

#include <algorithm>
#include <cmath>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;

TopoDS_Shape box_with_sphere() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, -2), gp_Pnt(2, 2, 2)).Shape();
  return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeSphere(1).Shape()).Shape();
}

Case pieces_case(const Folder& folder, const TopoDS_Shape& shape, double target, std::int64_t piece_tets) {
  Case input = cad_cases::coarse_case(folder.write(shape, "pieces.brep"), folder, target);
  input.domain.kind = geometry::DomainKind::fluid;
  input.piece_tets = piece_tets;
  return input;
}

TEST(VolumePieces, AreOneMeshForAnyNumberOfRanks) {
  const Folder folder;
  Case input = pieces_case(folder, box_with_sphere(), 60'000, 4'000);
  std::string alone;
  const RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_GE(record.parts, 10);
  EXPECT_NEAR(record.mesh_volume, 64 - 4 * M_PI / 3, 0.15);
  const InterfaceAngles& angles = record.volume.angles;
  EXPECT_GT(angles.edges, 100);
  EXPECT_LE(angles.below - angles.forced, angles.edges / 100);
  EXPECT_EQ(record.erasure.vertices_left, 0);
  EXPECT_GT(record.erasure.vertices_before, 1000);
  EXPECT_GT(record.erasure.mean_ratio_refilled, 0.97 * record.erasure.mean_ratio_elsewhere);
  EXPECT_GT(record.quality->mean_ratio.mean, 0.83);
  EXPECT_GT(record.quality->min_dihedral.minimum, 10);
  EXPECT_LT(record.conformity.bytes_per_cell, 60);
}

TEST(VolumePieces, KeepTheirInterfacesWhenAsked) {
  const Folder folder;
  Case input = pieces_case(folder, box_with_sphere(), 20'000, 2'500);
  input.erase_interfaces = false;
  input.interface_angle = 0;
  std::string alone;
  const RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_EQ(record.erasure.rounds, 0);
}

TEST(VolumePieces, RegionsAreDividedEachForItself) {
  const Folder folder;
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(0.5, 3).Shape();
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, 0), gp_Pnt(2, 2, 3)).Shape();
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepAlgoAPI_Cut(block, rod).Shape());
  builder.Add(both, rod);
  Case input = pieces_case(folder, both, 40'000, 5'000);
  std::string alone;
  const RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_EQ(record.regions_filled.size(), 2u);
  EXPECT_GT(record.parts, 4);
  EXPECT_EQ(record.erasure.vertices_left, 0);
}

class FailingPiece : public testing::TestWithParam<volume::VolumeOptions::Sabotage> {};

TEST_P(FailingPiece, IsMergedWithItsNeighbour) {
  const Folder folder;
  Case input = pieces_case(folder, box_with_sphere(), 20'000, 2'500);
  input.volume.sabotage = GetParam();
  input.volume.retries = GetParam() == volume::VolumeOptions::Sabotage::hangs ? 0 : 1;
  input.sabotaged_piece = 2;
  RunRecord record;
  run_case(parallel::Communicator::world(), input, record);
  const auto& merges = record.volume.merges;
  const auto merge = std::find_if(merges.begin(), merges.end(), [](const Merge& m) { return m.part == 2; });
  ASSERT_NE(merge, merges.end());
  EXPECT_NE(merge->reason.find("no way of filling it worked"), std::string::npos) << merge->reason;
  EXPECT_EQ(record.erasure.vertices_left, 0);
}

INSTANTIATE_TEST_SUITE_P(All, FailingPiece,
                         testing::Values(volume::VolumeOptions::Sabotage::throws,
                                         volume::VolumeOptions::Sabotage::aborts,
                                         volume::VolumeOptions::Sabotage::hangs,
                                         volume::VolumeOptions::Sabotage::exhausts_memory));

TEST(VolumePieces, ThatAllFailEndTheRunWithAReproducer) {
  const Folder folder;
  Case input = pieces_case(folder, box_with_sphere(), 8'000, 2'000);
  input.volume.sabotage = volume::VolumeOptions::Sabotage::throws;
  input.volume.retries = 1;
  std::filesystem::create_directories(input.output.directory);
  RunRecord record;
  try {
    run_case(parallel::Communicator::world(), input, record);
    FAIL() << "the failure went unnoticed";
  } catch (const StageFailure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::volume);
    const std::string text = failure.what();
    EXPECT_NE(text.find("offending_triangles.vtp"), std::string::npos) << text;
    EXPECT_NE(text.find("CAD faces"), std::string::npos) << text;
  }
  parallel::Communicator::world().barrier();
  EXPECT_TRUE(std::filesystem::exists(input.output.directory + "/offending_triangles.vtp"));
}

}  // namespace
}  // namespace aeroloom::pipeline
