#include "cad/repair/on_plane.hpp"

#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Line.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

/// Of an edge whose distance from a plane is measured; chosen, not measured.
constexpr int plane_samples = 32;
/// Points through which curves are drawn that are neither straight nor splines; chosen, not measured.
constexpr int drawn_points = 129;

template <class Visit>
void for_each_height(const TopoDS_Edge& edge, const AxisPlane& plane, Visit&& visit) {
  double first, last;
  const opencascade::handle<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull()) return;
  for (int i = 0; i <= plane_samples; ++i) {
    const gp_Pnt point = curve->Value(first + (last - first) * i / plane_samples);
    visit(point, plane.height(point));
  }
}

/// The straight line between the feet, at the same parameters.
opencascade::handle<Geom_Curve> draw_line(const opencascade::handle<Geom_Curve>& curve,
                                          const AxisPlane& plane, double first, double last) {
  TColgp_Array1OfPnt poles(1, 2);
  poles(1) = plane.foot(curve->Value(first)), poles(2) = plane.foot(curve->Value(last));
  TColStd_Array1OfReal knots(1, 2);
  knots(1) = first, knots(2) = last;
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom_BSplineCurve(poles, knots, multiplicities, 1);
}

/// A spline's feet are the spline of the feet of its poles.
opencascade::handle<Geom_Curve> drop_poles(const opencascade::handle<Geom_BSplineCurve>& curve,
                                           const AxisPlane& plane) {
  const opencascade::handle<Geom_BSplineCurve> dropped =
      opencascade::handle<Geom_BSplineCurve>::DownCast(curve->Copy());
  for (int i = 1; i <= dropped->NbPoles(); ++i) dropped->SetPole(i, plane.foot(dropped->Pole(i)));
  return {dropped.get()};
}

opencascade::handle<Geom_Curve> draw_feet(const opencascade::handle<Geom_Curve>& curve,
                                          const AxisPlane& plane, double first, double last) {
  const opencascade::handle<TColgp_HArray1OfPnt> points = new TColgp_HArray1OfPnt(1, drawn_points);
  const opencascade::handle<TColStd_HArray1OfReal> at = new TColStd_HArray1OfReal(1, drawn_points);
  for (int i = 1; i <= drawn_points; ++i) {
    const double t = i == drawn_points ? last : first + (last - first) * (i - 1) / (drawn_points - 1);
    at->SetValue(i, t);
    points->SetValue(i, plane.foot(curve->Value(t)));
  }
  GeomAPI_Interpolate interpolation(points, at, false, 0);
  interpolation.Perform();
  return interpolation.IsDone() ? opencascade::handle<Geom_Curve>(interpolation.Curve()) : nullptr;
}

opencascade::handle<Geom_Curve> basis_of(opencascade::handle<Geom_Curve> curve) {
  while (const auto trimmed = opencascade::handle<Geom_TrimmedCurve>::DownCast(curve))
    curve = trimmed->BasisCurve();
  return curve;
}

/// An edge that runs along the plane keeps its kind of curve.
opencascade::handle<Geom_Curve> shift(const opencascade::handle<Geom_Curve>& curve, const AxisPlane& plane,
                                      double height) {
  gp_Vec by(0, 0, 0);
  by.SetCoord(plane.axis + 1, -height);
  return opencascade::handle<Geom_Curve>::DownCast(curve->Translated(by));
}

}  // namespace

double distance_from(const AxisPlane& plane, const TopoDS_Edge& edge) {
  double most = 0;
  for_each_height(edge, plane,
                  [&](const gp_Pnt&, double height) { most = std::max(most, std::abs(height)); });
  return most;
}

opencascade::handle<Geom_Curve> curve_on_plane(const TopoDS_Edge& edge, const AxisPlane& plane, double& first,
                                               double& last) {
  const opencascade::handle<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull()) return nullptr;
  const opencascade::handle<Geom_Curve> basis = basis_of(curve);
  if (const auto spline = opencascade::handle<Geom_BSplineCurve>::DownCast(basis))
    return drop_poles(spline, plane);
  if (opencascade::handle<Geom_Line>::DownCast(basis)) return draw_line(basis, plane, first, last);
  double low = std::numeric_limits<double>::max(), high = -low;
  for_each_height(edge, plane, [&](const gp_Pnt&, double height) {
    low = std::min(low, height), high = std::max(high, height);
  });
  if (high - low <= tolerances::rounding *
                        (std::abs(low) + curve->Value(first).Distance(curve->Value(0.5 * (first + last)))))
    return shift(basis, plane, 0.5 * (low + high));
  return draw_feet(basis, plane, first, last);
}

PutOnPlane put_on_plane(const std::vector<TopoDS_Edge>& edges, const AxisPlane& plane) {
  PutOnPlane put;
  BRep_Builder builder;
  for (const TopoDS_Edge& each : edges) {
    const TopoDS_Edge edge = TopoDS::Edge(each.Oriented(TopAbs_FORWARD));
    double most = 0, first, last;
    Vec3 where;
    for_each_height(edge, plane, [&](const gp_Pnt& point, double height) {
      if (std::abs(height) > most) most = std::abs(height), where = to_vec(point);
    });
    if (most == 0) continue;
    const opencascade::handle<Geom_Curve> curve = curve_on_plane(edge, plane, first, last);
    if (curve.IsNull()) continue;
    builder.UpdateEdge(edge, curve, BRep_Tool::Tolerance(edge) + most);
    builder.Range(edge, first, last);
    for (const TopoDS_Vertex& vertex : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)}) {
      const gp_Pnt at = BRep_Tool::Pnt(vertex);
      const double height = std::abs(plane.height(at));
      if (height > 0) builder.UpdateVertex(vertex, plane.foot(at), BRep_Tool::Tolerance(vertex) + height);
      builder.UpdateVertex(vertex, BRep_Tool::Tolerance(edge));
    }
    ++put.edges;
    if (most > put.most) put.most = most, put.where = where;
  }
  return put;
}

}  // namespace aeroloom::cad
