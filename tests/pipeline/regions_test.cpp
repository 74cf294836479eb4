// Several solids that share faces, edges or nothing but a point: conforming regions, whatever the rank count.
#include "tests/pipeline/cad_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;
using cad_cases::together;

TopoDS_Shape box(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

struct Expected {
  std::vector<double> volumes;  // ascending
  int inner_patches;
};

void expect_regions(const TopoDS_Shape& shape, const Expected& expected) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(shape, "regions.brep"), folder, 3000);
  input.domain.kind = cad::DomainKind::fluid;
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  ASSERT_EQ(record.regions_filled.size(), expected.volumes.size());
  std::vector<double> volumes;
  for (const report::RegionRow& region : record.regions_filled) {
    EXPECT_FALSE(region.name.empty());
    EXPECT_GT(region.tetrahedra, 0);
    volumes.push_back(region.volume);
  }
  std::sort(volumes.begin(), volumes.end());
  for (std::size_t i = 0; i < volumes.size(); ++i) EXPECT_NEAR(volumes[i], expected.volumes[i], 1e-9);
  const double whole = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  EXPECT_NEAR(record.mesh_volume, whole, 1e-9 * whole);
  const auto inner = std::count_if(record.patches.begin(), record.patches.end(),
                                   [](const report::PatchRow& patch) { return patch.inner; });
  EXPECT_EQ(inner > 0, expected.inner_patches > 0);
  const bool written = std::filesystem::exists(input.output.directory + "/interfaces.pvtp");
  EXPECT_EQ(written, expected.inner_patches > 0);
}

TEST(RegionsLocal, TwoBoxesShareAFace) {
  expect_regions(together({box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 2, 1, 1)}), {{1, 2}, 1});
}

TEST(RegionsLocal, ABoxStandsOnPartOfAnother) {
  expect_regions(together({box(0, 0, 0, 3, 3, 1), box(1, 1, 1, 1, 1, 1)}), {{1, 9}, 1});
}

TEST(RegionsLocal, ABoxFillsTheVoidOfAnother) {
  const TopoDS_Shape core = box(1, 1, 1, 1, 1, 1);
  expect_regions(together({BRepAlgoAPI_Cut(box(0, 0, 0, 3, 3, 3), core).Shape(), core}), {{1, 26}, 1});
}

TEST(RegionsLocal, ASolidHasAVoid) {
  expect_regions(BRepAlgoAPI_Cut(box(0, 0, 0, 3, 3, 3), box(1, 1, 1, 1, 1, 1)).Shape(), {{26}, 0});
}

TEST(Regions, ThreeBoxesMeetAtOneEdge) {
  expect_regions(together({box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 1, 1, 1), box(0, 1, 0, 1, 1, 1)}),
                 {{1, 1, 1}, 1});
}

TEST(RegionsLocal, TwoBoxesTouchInAnEdgeAlone) {
  expect_regions(together({box(0, 0, 0, 1, 1, 1), box(1, 1, 0, 1, 1, 1)}), {{1, 1}, 0});
}

// Nothing but the common apex belongs to both, whether they are regions or bodies.
TEST(Regions, TwoConesMeetInTheirApexes) {
  const auto cone = [](double direction) {
    return BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, direction)), 0, 0.5, 1).Shape();
  };
  const double volume = std::numbers::pi * 0.25 / 3;
  const Folder folder;
  cases::Case input =
      cad_cases::coarse_case(folder.write(together({cone(1), cone(-1)}), "cones.brep"), folder, 1500);
  input.domain.kind = cad::DomainKind::fluid;
  std::string alone;
  const report::RunRecord regions = cad_cases::run_twice(input, alone);
  EXPECT_EQ(regions.hash, alone);
  ASSERT_EQ(regions.regions_filled.size(), 2u);
  for (const report::RegionRow& region : regions.regions_filled)
    EXPECT_NEAR(region.volume, volume, 0.05 * volume);
  input.domain.kind = cad::DomainKind::body;
  input.domain.far_field = cad::FarFieldOptions{.shape = cad::FarFieldShape::box, .extent = 1};
  input.improve.enabled = false;
  input.sizing.target_tetrahedra = 25'000;  // the apex takes half of it
  report::RunRecord bodies;
  run_case(parallel::Communicator::world(), input, bodies);
  EXPECT_NEAR(bodies.mesh_volume, 4 * 4 * 4 - 2 * volume, 0.1 * volume);
}

TEST(Regions, OverlappingSolidsAreRefusedWithAPlace) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(
      folder.write(together({box(0, 0, 0, 2, 1, 1), box(1, 0, 0, 2, 1, 1)}), "overlap.brep"), folder, 3000);
  input.domain.kind = cad::DomainKind::fluid;
  report::RunRecord record;
  try {
    run_case(parallel::Communicator::world(), input, record);
    ADD_FAILURE() << "overlapping solids were meshed";
  } catch (const report::StageFailure& failure) {
    EXPECT_EQ(failure.code(), report::ExitCode::cad);
    EXPECT_NE(std::string(failure.what()).find("overlap"), std::string::npos) << failure.what();
    EXPECT_NE(std::string(failure.what()).find("around (1.5, 0.5, 0.5)"), std::string::npos)
        << failure.what();
  }
}

// A solid of one shell that meets itself in an edge: two boxes, of volume 1 and 2.
TopoDS_Solid pinched_solid() {
  TopTools_ListOfShape boxes;
  boxes.Append(box(0, 0, 0, 1, 1, 1)), boxes.Append(box(1, 1, 0, 2, 1, 1));
  BRepAlgoAPI_BuilderAlgo common;
  common.SetArguments(boxes);
  common.Build();
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (TopExp_Explorer each(common.Shape(), TopAbs_FACE); each.More(); each.Next())
    builder.Add(shell, each.Current());
  shell.Closed(true);
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

TEST(Regions, ThatFallIntoPartsAreRefusedUnlessKept) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(pinched_solid(), "pinched.brep"), folder, 3000);
  input.domain.kind = cad::DomainKind::fluid;
  report::RunRecord refused;
  try {
    run_case(parallel::Communicator::world(), input, refused);
    ADD_FAILURE() << "two parts that nothing joins were meshed";
  } catch (const report::StageFailure& failure) {
    const std::string text = failure.what();
    EXPECT_EQ(failure.code(), report::ExitCode::surface);
    for (const char* part :
         {"falls into 2 parts", "2 around (2, 1.5, 0.5)", "1 around (0.5, 0.5, 0.5)", "geometry.chambers"})
      EXPECT_NE(text.find(part), std::string::npos) << part << ": " << text;
  }
  input.chambers = cases::ChamberUse::keep;
  std::string alone;
  const report::RunRecord kept = cad_cases::run_twice(input, alone);
  EXPECT_EQ(kept.hash, alone);
  EXPECT_NEAR(kept.mesh_volume, 3, 1e-9);
}

// A pin stands on a plate so that its outline touches the plate's rim in one point: two loops of one face
// share a vertex.
TEST(Regions, LoopsOfAFaceMayTouchInAVertex) {
  const TopoDS_Shape plate = box(0, 0, 0, 4, 4, 1);
  const TopoDS_Shape pin = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(3, 2, 1), gp_Dir(0, 0, 1)), 1, 2).Shape();
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(together({plate, pin}), "pin.brep"), folder, 20000);
  input.domain.kind = cad::DomainKind::body;
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_GT(record.counts.cells, 5000);
}

}  // namespace
}  // namespace aeroloom::pipeline
