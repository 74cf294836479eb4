/// Curves of edges drawn anew through other points.
#pragma once

#include <algorithm>
#include <vector>

#include <BRep_Tool.hxx>
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Surface.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::mutations {

inline constexpr int intervals = 400;  // of curves that are drawn anew

struct Stretch {
  Handle(Geom_Curve) curve;
  double first = 0, last = 0;
  double length = 0;
};

inline double parameter(const Stretch& stretch, int i) {
  return i == intervals ? stretch.last : stretch.first + (stretch.last - stretch.first) * i / intervals;
}
inline gp_Pnt at(const Stretch& stretch, int i) {
  return stretch.curve->Value(parameter(stretch, i));
}

/// Of an edge with a curve, about.
inline bool look_at(const TopoDS_Edge& edge, Stretch& stretch) {
  if (BRep_Tool::Degenerated(edge)) return false;
  stretch.curve = BRep_Tool::Curve(edge, stretch.first, stretch.last);
  if (stretch.curve.IsNull()) return false;
  for (int i = 0; i < intervals; ++i) stretch.length += at(stretch, i).Distance(at(stretch, i + 1));
  return true;
}
/// The image of points near a face; their parameters are those of the edge.
inline Handle(Geom2d_Curve) image(const TopoDS_Face& face, const Stretch& stretch, const TopoDS_Edge& old,
                                  const std::vector<gp_Pnt>& points) {
  double low, high;
  const Handle(Geom2d_Curve) before = BRep_Tool::CurveOnSurface(old, face, low, high);
  if (before.IsNull()) return {};
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  ShapeAnalysis_Surface analysis(surface);
  const Handle(TColgp_HArray1OfPnt2d) uv = new TColgp_HArray1OfPnt2d(1, intervals + 1);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, intervals + 1);
  for (int i = 0; i <= intervals; ++i) {
    const gp_Pnt2d guess = before->Value(low + (high - low) * i / intervals);
    gp_Pnt2d found = analysis.NextValueOfUV(guess, points[i], 1e-9);
    if (surface->Value(found.X(), found.Y()).Distance(points[i]) >
        surface->Value(guess.X(), guess.Y()).Distance(points[i]))
      found = guess;
    uv->SetValue(i + 1, found);
    parameters->SetValue(i + 1, parameter(stretch, i));
  }
  Geom2dAPI_Interpolate interpolation(uv, parameters, Standard_False, 0);
  interpolation.Perform();
  if (!interpolation.IsDone()) return {};
  return Handle(Geom2d_Curve)(interpolation.Curve().get());
}

inline Handle(Geom_Curve) through(const Stretch& stretch, const std::vector<gp_Pnt>& points) {
  const Handle(TColgp_HArray1OfPnt) places = new TColgp_HArray1OfPnt(1, intervals + 1);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, intervals + 1);
  for (int i = 0; i <= intervals; ++i) {
    places->SetValue(i + 1, points[i]);
    parameters->SetValue(i + 1, parameter(stretch, i));
  }
  GeomAPI_Interpolate interpolation(places, parameters, Standard_False, 0);
  interpolation.Perform();
  if (!interpolation.IsDone()) return {};
  return Handle(Geom_Curve)(interpolation.Curve().get());
}

/// Of the parameters of its edges, about.
inline void bounds_of(const TopoDS_Face& face, double& u0, double& u1, double& v0, double& v1) {
  u0 = v0 = 1e300, u1 = v1 = -1e300;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(face, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    double low, high;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(TopoDS::Edge(edges(i)), face, low, high);
    for (int k = 0; !curve.IsNull() && k <= 8; ++k) {
      const gp_Pnt2d uv = curve->Value(low + (high - low) * k / 8);
      u0 = std::min(u0, uv.X()), u1 = std::max(u1, uv.X());
      v0 = std::min(v0, uv.Y()), v1 = std::max(v1, uv.Y());
    }
  }
}

}  // namespace aeroloom::mutations
