/// Sizes that a face asks for where its chart cannot be filled.
#include "surface/charts/chart_mesher.hpp"

#include "surface/piece_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/surface/face_fixture.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;

/// A prism over the space between an arc, 0.06 high over a chord of one, and two lines below it that bend to
/// the same side, 0.03 high.
Model crescent() {
  const gp_Pnt a(0, 0, 0), b(1, 0, 0), below(0.5, 0, 0.03), above(0.5, 0, 0.06);
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, above, b).Value()).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(b, below).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(below, a).Edge());
  const TopoDS_Face section = BRepBuilderAPI_MakeFace(gp_Pln(a, gp_Dir(0, -1, 0)), wire.Wire()).Face();
  return cad::shapes::prepare_fluid(BRepPrimAPI_MakePrism(section, gp_Vec(0, 1, 0)).Shape()).model;
}

/// No vertices but those of the CAD.
CurveMesh chords_alone(const Model& model) {
  CurveMesh curves;
  for (cad::VertexId v = 0; v < model.vertex_count(); ++v) curves.points.push_back(model.vertex(v));
  curves.first_interior.assign(model.edge_count() + 1, model.vertex_count());
  return curves;
}

TEST(ChartMesherLocal, AsksForSmallerSizesWhereAChordIsBelowTheBorderBelowIt) {
  const Model model = crescent();
  const sizing::SizeField field = testing::uniform_field(model, 2);
  const CurveMesh curves = chords_alone(model);
  cad::FaceId section = 0;
  while (model.face(section).loops.front().size() != 3) ++section;
  const PieceProblem problem = problem_of_face(model, section, curves, field, {}).rest;
  try {
    mesh_piece(model, problem, field, {});
    FAIL() << "the chords run clockwise around the face";
  } catch (const FaceConflict& conflict) {
    ASSERT_FALSE(conflict.remedy().empty());
    for (const sizing::SizeSource& source : conflict.remedy()) EXPECT_LE(source.size, 0.5);
    EXPECT_NE(std::string(conflict.what()).find(" near "), std::string::npos) << conflict.what();
  }
}

}  // namespace
}  // namespace aeroloom::surface
