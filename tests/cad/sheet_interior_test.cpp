#include "cad/model/topology/sheet_interior.hpp"

#include "tests/cad/cad_shapes.hpp"

#include <cmath>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

/// A box with a bore through two sides, slanted in a third direction, and a dent: loops inside loops, planes,
/// cylinders and spheres, of which some close.
Model pierced_box() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(3, 2, 1)).Shape();
  const TopoDS_Shape bore =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.7, 0.9, -1), gp_Dir(0.2, 0.1, 1)), 0.4, 3).Shape();
  const TopoDS_Shape dent = BRepPrimAPI_MakeSphere(gp_Pnt(2.2, 1.1, 1.2), 0.5).Shape();
  return shapes::prepare_fluid(BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, bore).Shape(), dent).Shape()).model;
}

TEST(SheetInterior, AgreesWithTheLibrary) {
  const Model model = pierced_box();
  ASSERT_EQ(model.face_count(), 8);
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const FaceEvaluator& face = model.data().face_evaluators[f];
    const SheetInterior interior(face);
    const BRepTopAdaptor_FClass2d library(face.shape, 1e-9);
    const Vec2 extent = face.uv_high - face.uv_low;
    constexpr int count = 200;
    int inside = 0;
    // A little beyond the box of the loops, and round once more where the surface closes.
    for (int i = 0; i <= count; ++i) {
      for (int j = 0; j <= count; ++j) {
        const Vec2 uv{face.uv_low.x + (1.4 * i / count - 0.2) * extent.x,
                      face.uv_low.y + (1.4 * j / count - 0.2) * extent.y};
        const bool expected = library.Perform({uv.x, uv.y}) != TopAbs_OUT;
        inside += expected;
        ASSERT_EQ(interior.contains(uv), expected) << "face " << f << " at " << uv.x << " " << uv.y;
      }
    }
    EXPECT_GT(inside, count * count / 10);
  }
}

}  // namespace
}  // namespace aeroloom::cad
