// Layers on faces between regions and on baffles, from CAD: one mesh whatever the rank count, valid, and
// nearly everywhere with all layers.
#include "tests/pipeline/cad_cases.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;
using cad_cases::together;
using layers::InnerSides;

TopoDS_Shape duct() {
  return BRepPrimAPI_MakeBox(3.0, 1.0, 1.0).Shape();
}

/// A plate along the duct, whose normal is that of z.
TopoDS_Shape plate(double y_low, double y_high) {
  const gp_Pln plane(gp_Ax3(gp_Pnt(0, 0, 0.5), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)));
  return BRepBuilderAPI_MakeFace(plane, 1, 2, y_low, y_high).Shape();
}

TopoDS_Shape with_solid(const TopoDS_Shape& around, const TopoDS_Shape& solid) {
  return together({BRepAlgoAPI_Cut(around, solid).Shape(), solid});
}

struct Wanted {
  std::string patch;
  InnerSides side;
  std::vector<cases::PatchRule> patches = {};
  layers::LayerElements elements = layers::LayerElements::prisms;
};

report::RunRecord expect_layers(const TopoDS_Shape& shape, const Wanted& wanted, double full) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(shape, "inner.brep"), folder, 8000);
  input.domain.kind = cad::DomainKind::fluid;
  input.volume.piece_tets = 2000;
  input.patches = wanted.patches;
  input.layers.given = true;
  input.layers.first = 2e-3;
  input.layers.count = 6;
  input.layers.elements = wanted.elements;
  cases::LayerRule rule;
  rule.name = wanted.patch;
  rule.side = wanted.side;
  input.layers.patches.push_back(rule);
  std::string alone;
  report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_TRUE(record.layers);
  if (!record.layers) return record;
  const cad_cases::Coverage coverage = cad_cases::coverage_of(record);
  EXPECT_GT(coverage.full, full);
  EXPECT_LT(coverage.full, 1 + 1e-9);
  return record;
}

const layers::PatchLayers& layers_of(const report::RunRecord& record, const std::string& patch) {
  const auto found = std::find_if(record.patches.begin(), record.patches.end(),
                                  [&](const report::PatchRow& row) { return row.name == patch; });
  return record.layers->report.patches.at(static_cast<std::size_t>(found - record.patches.begin()));
}

TEST(InnerLayersOfCad, APlateInADuctHasThemOnBothSidesAndAroundItsRim) {
  const report::RunRecord record =
      expect_layers(together({duct(), plate(0.25, 0.75)}), {"baffle", InnerSides::both}, 0.98);
  EXPECT_NEAR(layers_of(record, "baffle").area, 2 * 0.5, 1e-9);
  EXPECT_GT(layers_of(record, "baffle").hexahedra, 0) << "over the rim";
  EXPECT_NEAR(record.mesh_volume, 3, 1e-9);
}

TEST(InnerLayersOfCad, APlateOnAWall) {
  const report::RunRecord record =
      expect_layers(together({duct(), plate(0, 0.6)}), {"baffle", InnerSides::both}, 0.96);
  EXPECT_GT(layers_of(record, "baffle").full_area, 0.7 * 2 * 0.6) << "but for the open rim";
}

TEST(InnerLayersOfCad, ASolidInAFluid) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(1.5, 1.5, 1.5), 0.7).Shape();
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(3.0, 3.0, 3.0).Shape();
  for (const InnerSides side : {InnerSides::front, InnerSides::back, InnerSides::both}) {
    const report::RunRecord record = expect_layers(with_solid(box, ball), {"interface_0_1", side}, 0.98);
    const double area = layers_of(record, "interface_0_1").area;
    EXPECT_NEAR(area, side == InnerSides::both ? 12.3 : 6.15, side == InnerSides::both ? 0.4 : 0.2);
  }
}

TEST(InnerLayersOfCad, ARodBetweenWallsAndBetweenPlanes) {
  const gp_Ax2 axis(gp_Pnt(1.5, 0, 0.5), gp_Dir(0, 1, 0));
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(axis, 0.2, 1.0).Shape();
  Wanted wanted{"interface_0_1", InnerSides::both};
  expect_layers(with_solid(duct(), rod), wanted, 0.98);
  wanted.elements = layers::LayerElements::tets;
  for (const char* const plane : {"ymin", "ymax"}) {
    cases::PatchRule rule;
    rule.name = plane;
    rule.type = mesh::PatchType::symmetry;
    wanted.patches.push_back(rule);
  }
  expect_layers(with_solid(duct(), rod), wanted, 0.98);
}

TEST(InnerLayersOfCad, TwoBoxesThatShareAFace) {
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(3, 0, 0), 1.0, 1.0, 1.0).Shape();
  expect_layers(together({duct(), other}), {"interface_0_1", InnerSides::both}, 0.98);
}

}  // namespace
}  // namespace aeroloom::pipeline
