#include "cad/repair/loop_face.hpp"

#include "cad/tolerances.hpp"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <gp_Pnt2d.hxx>

namespace aeroloom::cad {

TopoDS_Face face_within(const opencascade::handle<Geom_Surface>& surface, const TopoDS_Wire& wire) {
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, surface, tolerances::library_length);
  builder.Add(face, wire);
  return face;
}

double area_in_parameters(const std::vector<TopoDS_Edge>& loop, const TopoDS_Face& face) {
  constexpr int samples = 24;  // of an edge, only for the sign
  double twice = 0;
  for (const TopoDS_Edge& edge : loop) {
    double first, last;
    const opencascade::handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (curve.IsNull()) return 0;
    double sum = 0;
    gp_Pnt2d before = curve->Value(first);
    for (int i = 1; i <= samples; ++i) {
      const gp_Pnt2d next = curve->Value(first + (last - first) * i / samples);
      sum += before.X() * next.Y() - next.X() * before.Y();
      before = next;
    }
    twice += edge.Orientation() == TopAbs_REVERSED ? -sum : sum;
  }
  return 0.5 * twice;
}

}  // namespace aeroloom::cad
