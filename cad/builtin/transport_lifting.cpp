#include "cad/builtin/transport_components.hpp"
#include "cad/tolerances.hpp"

#include <cmath>
#include <numbers>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {
namespace {

constexpr int aerofoil_intervals = 16;   // of the interpolated upper and lower side
constexpr double camber_position = 0.4;  // of the largest camber, over chord
/// The axis about which incidence rotates a section, over chord: where a thin aerofoil's lift acts.
constexpr double incidence_axis = 0.25;
/// Of the angle, for a derivative by differences of second order: its error is the square of it, 1e-10.
constexpr double difference_step = 1e-5;
/// Points of the unit aerofoil that are nearer are one to the interpolation: none are.
constexpr double distinct_points = 1e-9;
/// Points of a section to test where it lies, in intervals of the interpolation.
constexpr int tested_per_interval = 4;

enum class WingSide { upper, lower };

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// A point of the four-digit aerofoil (Jacobs, Ward and Pinkerton, NACA report 460, 1933) of unit chord at
/// x = 1 - cos(angle), angle in [0, pi/2]: this parameter is regular at the leading and at the trailing edge.
Vec2 aerofoil(const LiftingSurface& surface, WingSide side, double angle) {
  const double x = 1 - std::cos(angle), root_x = std::numbers::sqrt2 * std::sin(0.5 * angle);
  // The last coefficient closes the trailing edge, whose thickness is then added linearly.
  double thickness =
      5 * surface.thickness * (0.2969 * root_x + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
  thickness += 0.5 * surface.trailing_edge * x;
  const double p = camber_position, m = surface.camber;
  const double scale = x < p ? m / (p * p) : m / ((1 - p) * (1 - p));
  const double camber = scale * (x < p ? x * (2 * p - x) : 1 - 2 * p + x * (2 * p - x));
  const double slope = std::atan(2 * scale * (p - x));
  const double sign = side == WingSide::upper ? 1 : -1;
  return {x - sign * thickness * std::sin(slope), camber + sign * thickness * std::cos(slope)};
}

gp_Pnt point_in_plane(Vec2 p) {
  return {p.x, p.y, 0};
}

/// Derivative by angle at an end of the range.
gp_Vec end_tangent(const LiftingSurface& surface, WingSide side, double angle, double inward) {
  const double step = difference_step * inward;
  const Vec2 a = aerofoil(surface, side, angle), b = aerofoil(surface, side, angle + step),
             c = aerofoil(surface, side, angle + 2 * step);
  const Vec2 d = (-3.0 * a + 4.0 * b - c) / (2 * step);
  return {d.x, d.y, 0};
}

/// One side of the unit aerofoil from the leading to the trailing edge. At the leading edge both sides have
/// the same tangent, so the faces join smoothly there.
Handle(Geom_BSplineCurve) interpolate_side(const LiftingSurface& surface, WingSide side) {
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, aerofoil_intervals + 1);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, aerofoil_intervals + 1);
  for (int i = 0; i <= aerofoil_intervals; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / aerofoil_intervals;
    points->SetValue(i + 1, point_in_plane(aerofoil(surface, side, angle)));
    parameters->SetValue(i + 1, angle);
  }
  GeomAPI_Interpolate interpolate(points, parameters, Standard_False, distinct_points);
  gp_Vec leading = end_tangent(surface, WingSide::upper, 0, 1);
  if (side == WingSide::lower) leading.Reverse();
  interpolate.Load(leading, end_tangent(surface, side, 0.5 * std::numbers::pi, -1), Standard_False);
  interpolate.Perform();
  return interpolate.Curve();
}

/// A copy of the unit curve with its control points moved.
template <class Place>
Handle(Geom_BSplineCurve) placed(const Handle(Geom_BSplineCurve) & unit, const Place& place) {
  Handle(Geom_BSplineCurve) curve = Handle(Geom_BSplineCurve)::DownCast(unit->Copy());
  for (int i = 1; i <= curve->NbPoles(); ++i) {
    const gp_Pnt p = curve->Pole(i);
    const Vec3 q = place(Vec2{p.X(), p.Y()});
    curve->SetPole(i, gp_Pnt(q.x, q.y, q.z));
  }
  return curve;
}

/// The ruled surface between two curves with the same knots.
Handle(Geom_Surface) rule(const Handle(Geom_BSplineCurve) & a, const Handle(Geom_BSplineCurve) & b) {
  TColgp_Array2OfPnt poles(1, a->NbPoles(), 1, 2);
  for (int i = 1; i <= a->NbPoles(); ++i) poles(i, 1) = a->Pole(i), poles(i, 2) = b->Pole(i);
  TColStd_Array1OfReal v_knots(1, 2);
  TColStd_Array1OfInteger v_multiplicities(1, 2);
  v_knots(1) = 0, v_knots(2) = 1;
  v_multiplicities.Init(2);
  return new Geom_BSplineSurface(poles, a->Knots(), v_knots, a->Multiplicities(), v_multiplicities,
                                 a->Degree(), 1);
}

Handle(Geom_BSplineCurve) line(Vec3 a, Vec3 b) {
  TColgp_Array1OfPnt poles(1, 2);
  poles(1) = gp_Pnt(a.x, a.y, a.z), poles(2) = gp_Pnt(b.x, b.y, b.z);
  TColStd_Array1OfReal knots(1, 2);
  TColStd_Array1OfInteger multiplicities(1, 2);
  knots(1) = 0, knots(2) = 1;
  multiplicities.Init(2);
  return new Geom_BSplineCurve(poles, knots, multiplicities, 1);
}

/// The planar face inside one section.
TopoDS_Face cap(const Handle(Geom_BSplineCurve) & upper, const Handle(Geom_BSplineCurve) & lower,
                gp_Dir normal) {
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(upper).Edge(), BRepBuilderAPI_MakeEdge(lower).Edge());
  if (!upper->EndPoint().IsEqual(lower->EndPoint(), tolerances::library_length)) {
    wire.Add(BRepBuilderAPI_MakeEdge(upper->EndPoint(), lower->EndPoint()).Edge());
  }
  return BRepBuilderAPI_MakeFace(gp_Pln(upper->StartPoint(), normal), wire.Wire());
}

}  // namespace

Vec3 Lifting::place(Vec2 point, double station) const {
  const auto at = [&](double chord, double incidence, double span) {
    const double x = chord * (point.x - incidence_axis), z = chord * point.y;
    const double c = std::cos(radians(incidence)), s = std::sin(radians(incidence));
    const Vec2 rotated{x * c + z * s + incidence_axis * chord, z * c - x * s};
    const double back = _surface.x + span * std::tan(radians(_surface.sweep)) + rotated.x;
    if (_to == SpreadTo::up) return Vec3{back, rotated.y, _surface.z + span};
    return Vec3{back, span, _surface.z + span * std::tan(radians(_surface.dihedral)) + rotated.y};
  };
  const double t = station / _surface.half_span;
  return (1 - t) * at(_surface.root_chord, _surface.root_incidence, 0) +
         t * at(_surface.root_chord * _surface.taper, _surface.tip_incidence, _surface.half_span);
}

std::vector<Vec3> Lifting::section(double station) const {
  std::vector<Vec3> points;
  for (const WingSide side : {WingSide::upper, WingSide::lower}) {
    for (int i = 0; i <= tested_per_interval * aerofoil_intervals; ++i) {
      points.push_back(place(
          aerofoil(_surface, side, 0.5 / tested_per_interval * std::numbers::pi * i / aerofoil_intervals),
          station));
    }
  }
  return points;
}

Component Lifting::make_component(const std::string& name, double inner_station) const {
  const bool up = _to == SpreadTo::up;
  const double outer_station = _surface.half_span;
  const auto inner = [&](Vec2 p) { return place(p, inner_station); };
  const auto outer = [&](Vec2 p) { return place(p, outer_station); };
  const auto upper = interpolate_side(_surface, WingSide::upper),
             lower = interpolate_side(_surface, WingSide::lower);
  const auto upper_inner = placed(upper, inner), upper_outer = placed(upper, outer);
  const auto lower_inner = placed(lower, inner), lower_outer = placed(lower, outer);
  const gp_Dir span = up ? gp::DZ() : gp::DY();
  std::vector<NamedFace> faces{
      {whole_face(rule(upper_inner, upper_outer)), name + (up ? "_right" : "_upper")},
      {whole_face(rule(lower_inner, lower_outer)), name + (up ? "_left" : "_lower")},
      {cap(upper_inner, lower_inner, span), name + "_root"},
      {cap(upper_outer, lower_outer, span), name + "_tip"}};
  if (_surface.trailing_edge > 0) {
    const Vec2 high = aerofoil(_surface, WingSide::upper, 0.5 * std::numbers::pi),
               low = aerofoil(_surface, WingSide::lower, 0.5 * std::numbers::pi);
    faces.push_back({whole_face(rule(line(inner(low), inner(high)), line(outer(low), outer(high)))),
                     name + "_trailing_edge"});
  }
  return sew_component(faces);
}

}  // namespace aeroloom::cad
