#include "cad/model/evaluation/face_integrals.hpp"

#include "cad_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using shapes::faces_of;

constexpr double pi = std::numbers::pi;
const Vec3 anywhere{0.3, -2, 5};

/// Of a closed shape: its area, and the volume that its outward flux amounts to.
FaceIntegrals integrate(const TopoDS_Shape& shape) {
  FaceIntegrals sum;
  for (const TopoDS_Face& face : faces_of(shape)) {
    const FaceIntegrals one = integrate_face(face, SurfaceEvaluator(BRep_Tool::Surface(face)), anywhere);
    sum.area += one.area;
    sum.flux += (face.Orientation() == TopAbs_REVERSED ? -1 : 1) * one.flux;
  }
  return sum;
}

void expect(const TopoDS_Shape& shape, double area, double volume, double precision) {
  const FaceIntegrals found = integrate(shape);
  EXPECT_NEAR(found.area, area, precision * area);
  EXPECT_NEAR(found.flux, volume, precision * volume);
}

TEST(FaceIntegrals, OfElementaryShapesAreExact) {
  expect(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape(), 22, 6, 1e-12);
  expect(BRepPrimAPI_MakeSphere(2).Shape(), 16 * pi, 32 * pi / 3, 1e-9);
  expect(BRepPrimAPI_MakeCylinder(1, 3).Shape(), 8 * pi, 3 * pi, 1e-6);
  expect(BRepPrimAPI_MakeTorus(3, 1).Shape(), 12 * pi * pi, 6 * pi * pi, 1e-6);
  expect(BRepPrimAPI_MakeCone(3, 0, 4).Shape(), 24 * pi, 12 * pi, 1e-6);
}

TEST(FaceIntegrals, OfSplinesHaveFourDigits) {
  const auto as_splines = [](const TopoDS_Shape& shape) {
    return BRepBuilderAPI_NurbsConvert(shape).Shape();
  };
  expect(as_splines(BRepPrimAPI_MakeSphere(2).Shape()), 16 * pi, 32 * pi / 3, 1e-4);
  expect(as_splines(BRepPrimAPI_MakeTorus(3, 1).Shape()), 12 * pi * pi, 6 * pi * pi, 1e-4);
}

TEST(FaceIntegrals, LeaveHolesOut) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, 0), gp_Pnt(2, 2, 1)).Shape();
  const TopoDS_Shape drilled = BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(1, 1).Shape()).Shape();
  expect(drilled, 2 * (16 - pi) + 16 + 2 * pi, 16 - pi, 1e-6);
}

TEST(FaceIntegrals, OfFacesCutByCurvesOfMeeting) {
  // Steinmetz: two cylinders of radius 1 that cross at right angles have 16/3 in common, of area 16.
  const double reach = 3;
  const TopoDS_Shape along_z =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -reach), gp_Dir(0, 0, 1)), 1, 2 * reach).Shape();
  const TopoDS_Shape along_x =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-reach, 0, 0), gp_Dir(1, 0, 0)), 1, 2 * reach).Shape();
  const TopoDS_Shape rest = BRepAlgoAPI_Cut(along_z, along_x).Shape();
  expect(rest, 2 * pi + 2 * pi * 2 * reach - 8 + 8, 2 * pi * reach - 16.0 / 3, 1e-4);
}

TEST(FaceIntegrals, OfFaceWithoutEdgesAreOfItsWholeSurface) {
  const TopoDS_Face sphere = faces_of(BRepPrimAPI_MakeSphere(2).Shape()).front();
  TopoDS_Face bare;
  BRep_Builder().MakeFace(bare, BRep_Tool::Surface(sphere), 1e-7);
  EXPECT_NEAR(integrate_face(bare, SurfaceEvaluator(BRep_Tool::Surface(bare)), anywhere).area, 16 * pi, 1e-6);
}

/// What integrals lack counts by the distance from which the region is seen.
TEST(RegionVolume, OfASmallRegionFarFromTheOthersIsPrecise) {
  const TopoDS_Shape half =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeTorus(0.01, 0.004).Shape(),
                      BRepPrimAPI_MakeBox(gp_Pnt(-1, -1, -1), gp_Pnt(1, 0.003, 1)).Shape())
          .Shape();
  const TopoDS_Shape splines = BRepBuilderAPI_NurbsConvert(half).Shape();
  gp_Trsf far;
  far.SetTranslation(gp_Vec(40, 0, 0));
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepPrimAPI_MakeBox(1, 1, 1).Shape());
  builder.Add(both, splines.Moved(TopLoc_Location(far)));
  const Model alone = shapes::prepare_fluid(splines).model, among = shapes::prepare_fluid(both).model;
  ASSERT_EQ(among.region_count(), 2);
  const double expected = alone.region_volume(0);
  EXPECT_NEAR(std::min(among.region_volume(0), among.region_volume(1)), expected, 2e-3 * expected);
}

}  // namespace
}  // namespace aeroloom::cad
