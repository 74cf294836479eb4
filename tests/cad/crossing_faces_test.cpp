// Walls that pass through each other are refused with names and place, before any mesh.
#include "cad/repair/crossing_faces.hpp"

#include "cad/domain/domain.hpp"
#include "tests/cad/cad_shapes.hpp"

#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <gp_Ax1.hxx>
#include <gp_Circ.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

/// A pipe of radius 1 that turns by 90 degrees about the axis z, which is `radius` away from its middle.
TopoDS_Shape bend(double radius) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(radius, 0, 0), gp_Dir(0, 1, 0)), 1);
  const TopoDS_Face section =
      BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire()).Face();
  return BRepPrimAPI_MakeRevol(section, gp_Ax1({0, 0, 0}, {0, 0, 1}), 1.5707963267948966).Shape();
}

DomainOptions as_fluid() {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  return options;
}

// The second section dips below the first one.
TEST(CrossingFaces, SectionsThatFoldAreRefusedWithFacesAndPlace) {
  BRepOffsetAPI_ThruSections loft(true, true);
  for (const gp_Ax2& axes : {gp_Ax2({0, 0, 0}, {0, 0, 1}), gp_Ax2({0.3, 0, 0.5}, {0.866, 0, 0.5})})
    loft.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(axes, 1)).Edge()).Wire());
  const std::string message = shapes::refusal(loft.Shape(), as_fluid());
  for (const char* const word : {"pass through each other", "faces '", "near (", "Remedy"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(CrossingFaces, ATightBendDoesNot) {
  EXPECT_TRUE(find_face_crossings(shapes::prepare(bend(1.05), as_fluid()).model).empty());
}

// Coarse facets of walls so near each other cross.
TEST(CrossingFaces, NearWallsDoNot) {
  const TopoDS_Shape film =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(1, 1).Shape(), BRepPrimAPI_MakeCylinder(0.999, 1).Shape())
          .Shape();
  EXPECT_TRUE(find_face_crossings(shapes::prepare(film, as_fluid()).model).empty());
}

TEST(CrossingFaces, FacesThatMeetAtTheirEdgesDoNot) {
  const TopoDS_Shape drilled =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(2, 2, 2).Shape(),
                      BRepPrimAPI_MakeCylinder(gp_Ax2({1, 1, -1}, {0.3, 0.1, 1}), 0.5, 5).Shape())
          .Shape();
  EXPECT_TRUE(find_face_crossings(shapes::prepare(drilled, as_fluid()).model).empty());
}

}  // namespace
}  // namespace aeroloom::cad
