#include "cad/repair/filled_loops.hpp"

#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/loop_face.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <BRepAdaptor_Curve.hxx>
#include <BRepFill_Filling.hxx>
#include <BRepGProp.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <ShapeFix_Edge.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>
#include <gp_Pnt2d.hxx>

namespace aeroloom::cad {
namespace {

using geometry::Vec3;

/// Of an edge; of the points that the surface is led through all edges have so many together, and each at
/// least the fewest. Chosen, not measured.
constexpr int edge_samples = 24, all_points = 160, fewest_points = 4, most_points = 16;
/// More edges than these take long, and are no missing face.
constexpr std::size_t most_edges = 60;
/// Of the area over the square of the length: in a strip sixty times as long as wide surfaces take long to
/// bend. Chosen, not measured.
constexpr double slenderest = 0.004;
/// Of the parameters on each side, where the surface is looked at for folds.
constexpr int fold_samples = 12;
/// Between the surface and the loop, as cosine of the angle of their normals.
constexpr double steepest = 0.1;

/// Points of a loop in its direction.
std::vector<Vec3> trace(const std::vector<TopoDS_Edge>& loop) {
  std::vector<Vec3> points;
  for (const TopoDS_Edge& edge : loop) {
    const BRepAdaptor_Curve curve(edge);
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    for (int i = 0; i < edge_samples; ++i) {
      const double share = static_cast<double>(i) / edge_samples;
      points.push_back(to_vec(
          curve.Value(first + (last - first) * (edge.Orientation() == TopAbs_REVERSED ? 1 - share : share))));
    }
  }
  return points;
}

/// Twice the area vector of a closed polygon.
Vec3 area_vector_of(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    sum += cross(points[i] - points[0], points[i + 1] - points[0]);
  return sum;
}

opencascade::handle<Geom_Surface> bend_surface(const std::vector<TopoDS_Edge>& loop, double tolerance) {
  const int points = std::clamp(all_points / static_cast<int>(loop.size()), fewest_points, most_points);
  try {
    BRepFill_Filling filling(3, points, 2, false, 1e-5, 0.1 * tolerance);
    for (const TopoDS_Edge& edge : loop) filling.Add(edge, GeomAbs_C0);
    filling.Build();
    if (!filling.IsDone()) return nullptr;
    return BRep_Tool::Surface(filling.Face());
  } catch (const Standard_Failure&) {
    return nullptr;
  }
}

/// Gives the edges parameter curves. Their largest distances from the surface; empty if one has no such
/// curve.
std::vector<double> lay_edges(const std::vector<TopoDS_Edge>& loop, const TopoDS_Face& face) {
  std::vector<double> distances;
  for (const TopoDS_Edge& edge : loop) {
    ShapeFix_Edge().FixAddPCurve(edge, face, false);
    double first, last;
    const opencascade::handle<Geom2d_Curve> image = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (image.IsNull()) return {};
    const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face);
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
    double off = 0;
    for (int i = 0; i <= edge_samples; ++i) {
      const double share = static_cast<double>(i) / edge_samples;
      const gp_Pnt2d at = image->Value(first + (last - first) * share);
      const double t = curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * share;
      off = std::max(off, surface->Value(at.X(), at.Y()).Distance(curve.Value(t)));
    }
    distances.push_back(off);
  }
  return distances;
}

/// Whether the face looks to one side of a plane normal to `along` all over.
bool is_graph(const TopoDS_Face& face, Vec3 along) {
  const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face);
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  const BRepTopAdaptor_FClass2d classifier(face, tolerances::on_loop);
  int ahead = 0, behind = 0, inside = 0;
  for (int i = 1; i < fold_samples; ++i) {
    for (int j = 1; j < fold_samples; ++j) {
      const gp_Pnt2d at(u0 + (u1 - u0) * i / fold_samples, v0 + (v1 - v0) * j / fold_samples);
      if (classifier.Perform(at) != TopAbs_IN) continue;
      gp_Pnt point;
      gp_Vec du, dv;
      surface->D1(at.X(), at.Y(), point, du, dv);
      const Vec3 normal = cross(Vec3{du.X(), du.Y(), du.Z()}, Vec3{dv.X(), dv.Y(), dv.Z()});
      const double cosine = dot(normal, along) / (norm(normal) * norm(along));
      ++inside, ahead += cosine > steepest, behind += cosine < -steepest;
    }
  }
  return ahead == inside || behind == inside;
}

/// Of an opening.
struct OpeningSize {
  double area = 0, length = 0;
};

bool is_small_or_narrow(const OpeningSize& opening, const WallSizes& walls) {
  const bool is_small = opening.area <= tolerances::small_opening_area * walls.area &&
                        opening.length <= tolerances::small_opening_length * walls.diagonal;
  return is_small || (2 * opening.area <= tolerances::widest_ruled * walls.diagonal * opening.length &&
                      opening.area <= tolerances::widest_filling * walls.area);
}

double length_around(const Cap& cap) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(cap.face, properties);
  return properties.Mass();
}

}  // namespace

std::optional<Cap> fill_loop(const std::vector<TopoDS_Edge>& loop, double tolerance) {
  if (loop.empty() || loop.size() > most_edges) return std::nullopt;
  report_step(fmt::format("filling an opening of {} edges", loop.size()));
  const opencascade::handle<Geom_Surface> surface = bend_surface(loop, tolerance);
  if (surface.IsNull()) return std::nullopt;
  TopoDS_Wire wire;
  BRep_Builder builder;
  builder.MakeWire(wire);
  for (const TopoDS_Edge& edge : loop) builder.Add(wire, edge);
  wire.Closed(true);
  Cap cap;
  cap.face = face_within(surface, wire);
  const std::vector<double> distances = lay_edges(loop, cap.face);
  if (distances.empty()) return std::nullopt;
  cap.deviation = *std::ranges::max_element(distances);
  if (cap.deviation > tolerance) return std::nullopt;
  const double turns = area_in_parameters(loop, cap.face);
  if (turns == 0) return std::nullopt;
  if (turns < 0) cap.face = face_within(surface, TopoDS::Wire(wire.Reversed()));
  if (!is_graph(cap.face, area_vector_of(trace(loop)))) return std::nullopt;
  for (std::size_t i = 0; i < loop.size(); ++i)
    builder.UpdateEdge(loop[i], distances[i] + BRep_Tool::Tolerance(loop[i]));
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(cap.face, properties);
  cap.area = std::abs(properties.Mass());
  cap.center = to_vec(properties.CentreOfMass());
  cap.is_filled = true;
  return cap;
}

std::optional<Cap> fill_narrow_loop(const std::vector<TopoDS_Edge>& loop, const WallSizes& walls,
                                    bool named) {
  const std::vector<Vec3> points = trace(loop);
  OpeningSize least{0.5 * norm(area_vector_of(points)), 0};
  for (std::size_t i = 0; i < points.size(); ++i)
    least.length += distance(points[i], points[(i + 1) % points.size()]);
  if (!named && !is_small_or_narrow(least, walls)) return std::nullopt;
  if (least.area < slenderest * least.length * least.length) return std::nullopt;
  std::optional<Cap> cap = fill_loop(loop, tolerances::planar_opening * walls.diagonal);
  if (!cap || named || is_small_or_narrow(*cap, walls)) return cap;
  return std::nullopt;
}

bool is_small_or_narrow(const Cap& cap, const WallSizes& walls) {
  return is_small_or_narrow(OpeningSize{cap.area, length_around(cap)}, walls);
}

bool is_gap(const Cap& cap, const WallSizes& walls) {
  const double length = length_around(cap);
  return cap.area < tolerances::narrowest_opening * walls.diagonal * length &&
         cap.area < tolerances::slender_opening * length * length;
}

}  // namespace aeroloom::cad
