// Faces inside of the fluid: one mesh whatever the rank count, valid and whole on both sides.
#include "tests/cad/real_files.hpp"
#include "tests/pipeline/cad_cases.hpp"

#include <algorithm>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;

TopoDS_Shape duct_with(const std::vector<TopoDS_Shape>& plates) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  builder.Add(compound, BRepPrimAPI_MakeBox(3.0, 1.0, 1.0).Shape());
  for (const TopoDS_Shape& each : plates) builder.Add(compound, each);
  return compound;
}

/// A rectangle across the duct, and one along it that meets it in a line.
TopoDS_Shape across(double y_low, double z_low, double y_high, double z_high) {
  const gp_Pln plane(gp_Ax3(gp_Pnt(1.5, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0)));
  return BRepBuilderAPI_MakeFace(plane, y_low, y_high, z_low, z_high).Shape();
}
TopoDS_Shape along() {
  const gp_Pln plane(gp_Ax3(gp_Pnt(0, 0, 0.5), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)));
  return BRepBuilderAPI_MakeFace(plane, 1, 2, 0.25, 0.75).Shape();
}

report::RunRecord expect_one_mesh(const TopoDS_Shape& shape, double area,
                                  const cases::LayerRequest& layers = {}) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(shape, "baffles.brep"), folder, 8000);
  input.domain.kind = cad::DomainKind::fluid;
  input.volume.piece_tets = 2000;
  input.layers = layers;
  std::string alone;
  report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_NEAR(record.mesh_volume, 3, 1e-9);
  EXPECT_EQ(record.regions_filled.size(), 1u);
  const auto baffle = std::find_if(record.patches.begin(), record.patches.end(),
                                   [](const report::PatchRow& patch) { return patch.name == "baffle"; });
  EXPECT_NE(baffle, record.patches.end());
  if (baffle != record.patches.end()) {
    EXPECT_TRUE(baffle->inner);
    EXPECT_EQ(baffle->type, mesh::PatchType::interior);
    EXPECT_NEAR(baffle->area, area, 1e-9);
  }
  EXPECT_TRUE(std::filesystem::exists(input.output.directory + "/interfaces.pvtp"));
  return record;
}

TEST(Baffles, AFreePlateIsMeshedOnce) {
  expect_one_mesh(duct_with({across(0.25, 0.25, 0.75, 0.75)}), 0.25);
}

TEST(Baffles, HaveLayersBesideThemAlone) {
  cases::LayerRequest layers;
  layers.given = true;
  layers.first = 0.01;
  layers.total = 0.05;
  const report::RunRecord record = expect_one_mesh(duct_with({across(0.25, 0, 0.75, 0.5)}), 0.25, layers);
  ASSERT_TRUE(record.layers);
  double asked = 0, full = 0;
  for (const layers::PatchLayers& patch : record.layers->report.patches)
    asked += patch.area, full += patch.full_area;
  EXPECT_NEAR(asked, 14, 1e-9) << "of the duct alone";
  EXPECT_GT(full, 12);
}

TEST(Baffles, PlatesOnAWallMeetInALine) {
  expect_one_mesh(duct_with({across(0.25, 0, 0.75, 0.75), along()}), 0.875);
}

}  // namespace
}  // namespace aeroloom::pipeline
