#include "geometry/repair_edges.hpp"

#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <fmt/format.h>

namespace aeroloom::geometry {

void repair_edges(const TopoDS_Shape& shape, std::vector<std::string>& changes) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, users);
  int curves = 0, images = 0;
  for (int i = 1; i <= users.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i).Oriented(TopAbs_FORWARD));
    if (BRep_Tool::Degenerated(edge)) continue;
    double first, last;
    if (BRep_Tool::Curve(edge, first, last).IsNull()) curves += BRepLib::BuildCurve3d(edge);
    for (const TopoDS_Shape& shape_of_face : users(i)) {
      const TopoDS_Face face = TopoDS::Face(shape_of_face.Oriented(TopAbs_FORWARD));
      if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull()) {
        images += ShapeFix_Edge().FixAddPCurve(edge, face, BRep_Tool::IsClosed(edge, face));
      }
    }
  }
  if (curves > 0) changes.push_back(fmt::format("{} edges got the curve they lacked", curves));
  if (images > 0)
    changes.push_back(fmt::format("{} edges got the parameter curve they lacked on a face", images));
}

}  // namespace aeroloom::geometry
