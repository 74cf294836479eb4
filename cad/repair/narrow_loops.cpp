#include "cad/repair/narrow_loops.hpp"

#include "cad/model/to_vec.hpp"
#include "cad/repair/loop_face.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomConvert.hxx>
#include <GeomFill.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>

namespace aeroloom::cad {
namespace {

double border_length(const TopoDS_Edge& edge) {
  return GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
}

/// The curve of an edge in its direction.
opencascade::handle<Geom_BSplineCurve> spline_along(const TopoDS_Edge& edge) {
  double first, last;
  const opencascade::handle<Geom_Curve> curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull()) return nullptr;
  opencascade::handle<Geom_BSplineCurve> spline =
      GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve, first, last));
  if (edge.Orientation() == TopAbs_REVERSED) spline->Reverse();
  return spline;
}

/// Ruled between the two opposite edges that are longer together.
TopoDS_Face rule(const std::vector<TopoDS_Edge>& loop) {
  std::array<double, 4> lengths{};
  for (std::size_t i = 0; i < 4; ++i) lengths[i] = border_length(loop[i]);
  const std::size_t side = lengths[0] + lengths[2] >= lengths[1] + lengths[3] ? 0 : 1;
  const opencascade::handle<Geom_BSplineCurve> there = spline_along(loop[side]),
                                               back = spline_along(loop[side + 2]);
  if (there.IsNull() || back.IsNull()) return {};
  back->Reverse();
  const opencascade::handle<Geom_Surface> surface = GeomFill::Surface(there, back);
  if (surface.IsNull()) return {};
  BRep_Builder builder;
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  for (const TopoDS_Edge& edge : loop) builder.Add(wire, edge);
  wire.Closed(true);
  const TopoDS_Face face = face_within(surface, wire);
  for (const TopoDS_Edge& edge : loop) ShapeFix_Edge().FixAddPCurve(edge, face, false);
  const double area = area_in_parameters(loop, face);
  if (area == 0) return {};
  return area > 0 ? face : face_within(surface, TopoDS::Wire(wire.Reversed()));
}

/// A part of at most four edges, or a planar one.
std::optional<Cap> span_part(const std::vector<TopoDS_Edge>& loop, const NarrowLimits& limits) {
  double length = 0;
  for (const TopoDS_Edge& edge : loop) length += border_length(edge);
  const auto is_narrow = [&](const Cap& cap) { return 2 * cap.area <= limits.widest * length; };
  std::vector<Cap> planar = cap_openings(loop, limits.planar);
  if (planar.size() == 1) return is_narrow(planar.front()) ? std::optional(planar.front()) : std::nullopt;
  if (loop.size() != 4) return std::nullopt;
  Cap cap;
  cap.face = rule(loop);
  if (cap.face.IsNull()) return std::nullopt;
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(cap.face, properties);
  cap.area = std::abs(properties.Mass());
  cap.center = to_vec(properties.CentreOfMass());
  return is_narrow(cap) ? std::optional(cap) : std::nullopt;
}

/// A line between two vertices of a loop, numbers of the edges that begin there.
struct Cut {
  std::size_t from = 0, to = 0;
  double length = 0;
};

/// The shortest cut that is short beside both parts of the loop: its ends face each other.
std::optional<Cut> find_cut(const std::vector<TopoDS_Edge>& loop, double widest) {
  constexpr double most_of_part = 0.25;  // of the length of a part. Chosen, not measured
  std::vector<double> begins{0};
  std::vector<gp_Pnt> corners;
  for (const TopoDS_Edge& edge : loop) {
    corners.push_back(BRep_Tool::Pnt(TopExp::FirstVertex(edge, true)));
    begins.push_back(begins.back() + border_length(edge));
  }
  std::optional<Cut> best;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    for (std::size_t j = i + 2; j < loop.size() && j < i + loop.size() - 1; ++j) {
      const double length = corners[i].Distance(corners[j]), part = begins[j] - begins[i];
      if (length > widest || length > most_of_part * std::min(part, begins.back() - part)) continue;
      if (!best || length < best->length) best = Cut{i, j, length};
    }
  }
  return best;
}

}  // namespace

std::vector<Cap> span_narrow_loop(const std::vector<TopoDS_Edge>& loop, const NarrowLimits& limits) {
  if (const std::optional<Cap> cap = span_part(loop, limits)) return {*cap};
  if (loop.size() <= 4) return {};
  const std::optional<Cut> cut = find_cut(loop, limits.widest);
  if (!cut) return {};
  BRepBuilderAPI_MakeEdge line(TopExp::FirstVertex(loop[cut->from], true),
                               TopExp::FirstVertex(loop[cut->to], true));
  if (!line.IsDone()) return {};
  const auto begin = loop.begin();
  const auto from = begin + static_cast<std::ptrdiff_t>(cut->from),
             to = begin + static_cast<std::ptrdiff_t>(cut->to);
  std::vector<TopoDS_Edge> outer(begin, from), inner(from, to);
  outer.push_back(line.Edge());
  outer.insert(outer.end(), to, loop.end());
  inner.push_back(TopoDS::Edge(line.Edge().Reversed()));
  std::vector<Cap> caps = span_narrow_loop(outer, limits);
  const std::vector<Cap> more = span_narrow_loop(inner, limits);
  if (caps.empty() || more.empty()) return {};
  caps.insert(caps.end(), more.begin(), more.end());
  return caps;
}

}  // namespace aeroloom::cad
