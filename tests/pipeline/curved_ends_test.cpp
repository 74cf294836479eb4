// Layers that end on curved faces, from CAD: one mesh whatever the rank count, valid, and nearly everywhere
// with all layers.
#include "tests/pipeline/cad_cases.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Splitter.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopTools_ListOfShape.hxx>
#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;
using mesh::PatchType;

/// A pipe of radius 1 and length 3 along z: `bulge` of its first end, outwards; the other end is a plane.
/// Faces: the bulge, the pipe, the plane.
TopoDS_Shape pipe(double bulge) {
  const auto at = [](double x, double z) { return gp_Pnt(x, 0, z); };
  const double radius = (1 + bulge * bulge) / (2 * std::abs(bulge)), middle = 0.5 * std::asin(1 / radius);
  const double rise = radius * (1 - std::cos(middle));
  BRepBuilderAPI_MakeWire wire;
  const double z = -bulge + std::copysign(rise, bulge);
  const Handle(Geom_Curve)
      curve(GC_MakeArcOfCircle(at(0, -bulge), at(radius * std::sin(middle), z), at(1, 0)).Value());
  wire.Add(BRepBuilderAPI_MakeEdge(curve).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(at(1, 0), at(1, 3)).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(at(1, 3), at(0, 3)).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(at(0, 3), at(0, -bulge)).Edge());
  const gp_Ax1 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(wire.Wire(), true).Face(), axis).Shape();
}

TopoDS_Shape half(const TopoDS_Shape& shape, double side) {
  const gp_Pnt low(-9, side > 0 ? -9 : 0, -9), high(9, side > 0 ? 0 : 9, 9);
  return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeBox(low, high).Shape()).Shape();
}

struct PatchOf {
  std::string face;
  PatchType type;
};

report::RunRecord expect_layers(const TopoDS_Shape& shape, const std::vector<PatchOf>& patches, double full,
                                const std::string& inner = "") {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(shape, "curved.brep"), folder, 15'000);
  input.domain.kind = cad::DomainKind::fluid;
  input.volume.piece_tets = 4000;
  for (const PatchOf& each : patches) {
    cases::PatchRule rule;
    rule.name = "of_" + each.face;
    rule.faces = {each.face};
    rule.type = each.type;
    input.patches.push_back(rule);
  }
  input.layers.given = true;
  input.layers.first = 2e-3;
  input.layers.count = 10;
  if (!inner.empty()) {
    cases::LayerRule rule;
    rule.name = inner;
    rule.side = layers::InnerSides::both;
    input.layers.patches.push_back(rule);
  }
  std::string alone;
  report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_TRUE(record.layers);
  if (!record.layers) return record;
  const cad_cases::Coverage coverage = cad_cases::coverage_of(record);
  EXPECT_GT(coverage.full, full);
  EXPECT_EQ(coverage.none, 0) << "layers reach the curved ends";
  return record;
}

TEST(CurvedEndsOfCad, ADomedAndADishedInlet) {
  for (const double bulge : {0.3, -0.3}) {
    expect_layers(pipe(bulge),
                  {{"face_0", PatchType::inlet}, {"face_1", PatchType::wall}, {"face_2", PatchType::outlet}},
                  0.98);
  }
}

TEST(CurvedEndsOfCad, ADomeThatMeetsAPlaneOfSymmetry) {
  expect_layers(half(pipe(0.3), 1),
                {{"face_0", PatchType::inlet},
                 {"face_1", PatchType::symmetry},
                 {"face_2", PatchType::wall},
                 {"face_3", PatchType::outlet}},
                0.98);
}

TEST(CurvedEndsOfCad, ARodThroughASphericalFarField) {
  const gp_Ax2 axis(gp_Pnt(0, 0, -4), gp_Dir(0, 0, 1));
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(axis, 0.4, 8).Shape();
  expect_layers(BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(2.0).Shape(), rod).Shape(),
                {{"face_0", PatchType::farfield}, {"face_1", PatchType::wall}}, 0.98);
}

/// The face between two halves of a pipe has layers on both sides, which end on both halves of the dome.
TEST(CurvedEndsOfCad, AFaceBetweenRegionsThatMeetsThem) {
  BRepBuilderAPI_MakePolygon square(gp_Pnt(-2, 0, -2), gp_Pnt(2, 0, -2), gp_Pnt(2, 0, 5), gp_Pnt(-2, 0, 5),
                                    true);
  TopTools_ListOfShape parts, tools;
  parts.Append(pipe(0.3));
  tools.Append(BRepBuilderAPI_MakeFace(square.Wire()).Shape());
  BRepAlgoAPI_Splitter splitter;
  splitter.SetArguments(parts);
  splitter.SetTools(tools);
  splitter.Build();
  expect_layers(splitter.Shape(),
                {{"face_0", PatchType::inlet},
                 {"face_3", PatchType::outlet},
                 {"face_4", PatchType::inlet},
                 {"face_6", PatchType::outlet}},
                0.98, "interface_0_1");
}

}  // namespace
}  // namespace aeroloom::pipeline
