// A region in many volume pieces: the mesh of one piece, whatever the rank count.
#include "tests/pipeline/cad_cases.hpp"
#include "tests/scoped_fault.hpp"

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

cases::Case pieces_case(const Folder& folder, const TopoDS_Shape& shape, double target,
                        std::int64_t piece_tets) {
  cases::Case input = cad_cases::coarse_case(folder.write(shape, "pieces.brep"), folder, target);
  input.domain.kind = cad::DomainKind::fluid;
  input.volume.piece_tets = piece_tets;
  return input;
}

TEST(VolumePieces, AreOneMeshForAnyNumberOfRanks) {
  const Folder folder;
  const cases::Case input = pieces_case(folder, box_with_sphere(), 60'000, 2'500);
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_GE(record.decomposition.zones, 10);
  EXPECT_NEAR(record.mesh_volume, 64 - 4 * M_PI / 3, 0.15);
  EXPECT_GT(record.quality->mean_ratio.mean, 0.83);
  EXPECT_GT(record.quality->min_dihedral.minimum, 10);
  EXPECT_LT(record.conformity.bytes_per_cell, 60);
}

TEST(VolumePieces, AreTheMeshOfOnePiece) {
  const Folder folder;
  cases::Case input = pieces_case(folder, box_with_sphere(), 20'000, 2'000);
  input.improve.enabled = false;
  report::RunRecord many, one;
  run_case(parallel::Communicator::world(), input, many);
  input.volume.piece_tets = 1'000'000'000;
  run_case(parallel::Communicator::world(), input, one);
  EXPECT_GE(many.decomposition.zones, 5);
  EXPECT_EQ(one.decomposition.zones, 1);
  EXPECT_EQ(many.counts.cells, one.counts.cells);
  EXPECT_EQ(many.counts.vertices, one.counts.vertices);
  EXPECT_EQ(many.decomposition.lattice_points, one.decomposition.lattice_points);
}

TEST(VolumePieces, OfTwoRegionsKeepThemApart) {
  const Folder folder;
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(0.5, 3).Shape();
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, 0), gp_Pnt(2, 2, 3)).Shape();
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepAlgoAPI_Cut(block, rod).Shape());
  builder.Add(both, rod);
  const cases::Case input = pieces_case(folder, both, 40'000, 3'000);
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_EQ(record.regions_filled.size(), 2u);
  EXPECT_GT(record.decomposition.zones, 4);
}

void expect_merged_with_neighbour(const std::string& fault) {
  const Folder folder;
  cases::Case input = pieces_case(folder, box_with_sphere(), 20'000, 2'500);
  const ScopedFault injected("zone=" + fault + "@2");
  input.improve.enabled = false;
  input.volume.retries = fault == "hangs" ? 0 : 1;
  input.volume.base_cpu_seconds = 1;  // what hangs need not do so for long
  report::RunRecord record;
  run_case(parallel::Communicator::world(), input, record);
  const auto& retries = record.volume.retries;
  const auto merge = std::find_if(retries.begin(), retries.end(), [](const volume::Retry& retry) {
    return retry.zone == 2 && retry.change.find("merged") != std::string::npos;
  });
  ASSERT_NE(merge, retries.end());
  EXPECT_FALSE(merge->reason.empty());
}

TEST(VolumePieces, ThatFailEndMergedWithTheirNeighbours) {
  for (const char* fault : {"throws", "aborts"}) expect_merged_with_neighbour(fault);
}

// On several ranks: FailingChild, in tests/volume/filling.
TEST(VolumePiecesLocal, WithoutEndEndMergedWithTheirNeighbours) {
  for (const char* fault : {"hangs", "exhausts_memory"}) expect_merged_with_neighbour(fault);
}

TEST(VolumePieces, ThatAllFailEndTheRunWithAReproducer) {
  const Folder folder;
  cases::Case input = pieces_case(folder, box_with_sphere(), 8'000, 2'000);
  const ScopedFault injected("zone=throws");
  input.volume.retries = 1;
  std::filesystem::create_directories(input.output.directory);
  report::RunRecord record;
  try {
    run_case(parallel::Communicator::world(), input, record);
    FAIL() << "the failure went unnoticed";
  } catch (const report::StageFailure& failure) {
    EXPECT_EQ(failure.code(), report::ExitCode::volume);
    const std::string text = failure.what();
    EXPECT_NE(text.find("offending_triangles.vtp"), std::string::npos) << text;
    EXPECT_NE(text.find("CAD faces"), std::string::npos) << text;
  }
  parallel::Communicator::world().barrier();
  EXPECT_TRUE(std::filesystem::exists(input.output.directory + "/offending_triangles.vtp"));
}

}  // namespace
}  // namespace aeroloom::pipeline
