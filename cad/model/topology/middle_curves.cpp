#include "cad/model/topology/middle_curves.hpp"

#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>

#include <GeomAPI_Interpolate.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>

namespace aeroloom::cad {
namespace {

/// A middle curve is drawn through more points until it leaves the middle by less than this fraction of the
/// strip's width: a thousandth of a width is less than any element shows. Chosen, not measured.
constexpr double middle_error = 1e-3;
/// Where the most do not suffice the curve is as it is: borders with a kink nobody marked cannot be followed.
constexpr int fewest_points = 32, most_points = 1024;
/// Joints face each other when they are no farther apart than the strip is wide, and half as much again where
/// borders run askew. Chosen, not measured.
constexpr double facing_width = 1.5;
/// A moved end takes its surroundings along by this power of the fraction of its radius that is left: smooth,
/// and without a curvature of its own to speak of.
constexpr double fading = 4;

/// A vertex or kink inside a border.
struct Joint {
  double passed;
  VertexId vertex;
};

std::vector<Joint> inner_joints(const Model& model, const std::vector<BorderEdge>& chain,
                                const BorderPath& path) {
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (i > 0) joints.push_back({path.joints()[i], path.vertices()[i]});
    const EdgeId edge = chain[i].strip_use.edge;
    const std::vector<double> breaks = model.edge_breaks(edge);
    for (std::size_t b = 1; b + 1 < breaks.size(); ++b) {
      const double step = tolerances::beside_knot * (breaks.back() - breaks.front());
      const Vec3 before = model.edge_tangent(edge, breaks[b] - step);
      const Vec3 after = model.edge_tangent(edge, breaks[b] + step);
      if (angle_between(before, after) < tolerances::kink) continue;
      joints.push_back({path.passed_at(i, breaks[b]), no_entity});
    }
  }
  std::sort(joints.begin(), joints.end(), [](const Joint& a, const Joint& b) { return a.passed < b.passed; });
  return joints;
}

Handle(Geom_BSplineCurve) interpolate(const std::vector<Vec3>& points, const std::vector<double>& at) {
  const int count = static_cast<int>(points.size());
  const Handle(TColgp_HArray1OfPnt) places = new TColgp_HArray1OfPnt(1, count);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, count);
  for (int i = 0; i < count; ++i) {
    places->SetValue(i + 1, to_gp(points[i]));
    parameters->SetValue(i + 1, at[i]);
  }
  GeomAPI_Interpolate interpolation(places, parameters, false, 0);
  interpolation.Perform();
  if (!interpolation.IsDone()) throw CadError("no curve can be drawn between the borders of a strip");
  return interpolation.Curve();
}

/// Middles and their places on the borders at even fractions between two stations.
struct Middles {
  std::vector<Vec3> points;
  std::array<std::vector<double>, 2> parameters;
  double width = 0;  ///< largest distance between the borders
};

Middles sample_middles(const std::array<BorderPath, 2>& borders, const Station& from, const Station& to,
                       const std::array<std::size_t, 2>& edges, int intervals) {
  Middles middles;
  for (int i = 0; i <= intervals; ++i) {
    const double fraction = static_cast<double>(i) / intervals;
    std::array<Vec3, 2> points;
    for (int side = 0; side < 2; ++side) {
      const double passed = (1 - fraction) * from.passed[side] + fraction * to.passed[side];
      const BorderPath::ChainPlace place = borders[side].at(passed, edges[side]);
      points[side] = place.point;
      middles.parameters[side].push_back(place.parameter);
    }
    middles.points.push_back(0.5 * (points[0] + points[1]));
    middles.width = std::max(middles.width, distance(points[0], points[1]));
  }
  return middles;
}

/// Runs from `first` to `last` instead.
void shift_ends(std::vector<Vec3>& points, Vec3 first, Vec3 last) {
  const Vec3 by_first = first - points.front(), by_last = last - points.back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(points.size() - 1);
    points[i] += (1 - fraction) * by_first + fraction * by_last;
  }
  points.front() = first, points.back() = last;
}

Handle(Geom_BSplineCurve) straight(Vec3 from, Vec3 to, double low, double high) {
  TColgp_Array1OfPnt poles(1, 2);
  poles(1) = to_gp(from), poles(2) = to_gp(to);
  TColStd_Array1OfReal knots(1, 2);
  knots(1) = low, knots(2) = high;
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom_BSplineCurve(poles, knots, multiplicities, 1);
}

/// The curve as a spline with the same parameters; null where it is another kind of curve.
Handle(Geom_BSplineCurve) as_spline(const GeomAdaptor_Curve& curve) {
  const double low = curve.FirstParameter(), high = curve.LastParameter();
  if (curve.GetType() != GeomAbs_BSplineCurve && curve.GetType() != GeomAbs_BezierCurve) return {};
  if (curve.IsPeriodic()) return {};
  const Handle(Geom_TrimmedCurve) part = new Geom_TrimmedCurve(curve.Curve(), low, high);
  const Handle(Geom_BSplineCurve) spline = GeomConvert::CurveToBSplineCurve(part);
  const double error = tolerances::rounding * (high - low);
  const bool same =
      std::abs(spline->FirstParameter() - low) <= error && std::abs(spline->LastParameter() - high) <= error;
  return same ? spline : Handle(Geom_BSplineCurve)();
}

/// The mean of the knots that a control point stands for.
double greville(const TColStd_Array1OfReal& knots, int pole, int degree) {
  double sum = 0;
  for (int i = 1; i <= degree; ++i) sum += knots(pole + i);
  return sum / degree;
}

}  // namespace

std::vector<Station> place_stations(const Model& model, const BluntEdge& strip,
                                    const std::array<BorderPath, 2>& borders) {
  const std::vector<Joint> joints[2] = {inner_joints(model, strip.borders[0], borders[0]),
                                        inner_joints(model, strip.borders[1], borders[1])};
  const Station start{{0, 0}, {borders[0].vertices().front(), borders[1].vertices().front()}};
  const Station end{{borders[0].length(), borders[1].length()},
                    {borders[0].vertices().back(), borders[1].vertices().back()}};
  double apart =
      0;  // at equal fractions of the way: more than the strip is wide where borders' lengths differ
  constexpr int intervals = 10;  // a width changes slowly along a strip
  for (int i = 0; i <= intervals; ++i) {
    const double fraction = static_cast<double>(i) / intervals;
    apart = std::max(apart, distance(borders[0].at(fraction * borders[0].length()).point,
                                     borders[1].at(fraction * borders[1].length()).point));
  }
  // First those that face each other ...
  std::vector<Station> facing{start};
  std::size_t next = 0;
  for (const Joint& a : joints[0]) {
    const auto gap = [&](const Joint& b) {
      return distance(borders[0].at(a.passed).point, borders[1].at(b.passed).point);
    };
    std::size_t best = joints[1].size();
    double least = facing_width * apart;
    for (std::size_t i = next; i < joints[1].size(); ++i) {
      if (gap(joints[1][i]) < least) least = gap(joints[1][i]), best = i;
    }
    if (best == joints[1].size()) continue;
    facing.push_back({{a.passed, joints[1][best].passed}, {a.vertex, joints[1][best].vertex}});
    next = best + 1;
  }
  facing.push_back(end);
  // ... then the others, at the same fraction of the way between those.
  std::vector<Station> stations = facing;
  for (int side = 0; side < 2; ++side) {
    for (const Joint& joint : joints[side]) {
      const auto above =
          std::ranges::find_if(facing, [&](const Station& s) { return s.passed[side] >= joint.passed; });
      if (above->passed[side] == joint.passed) continue;
      const Station &low = *(above - 1), &high = *above;
      const double fraction = (joint.passed - low.passed[side]) / (high.passed[side] - low.passed[side]);
      Station alone;
      alone.passed[side] = joint.passed;
      alone.passed[1 - side] = (1 - fraction) * low.passed[1 - side] + fraction * high.passed[1 - side];
      alone.vertices[side] = joint.vertex;
      stations.push_back(alone);
    }
  }
  std::ranges::sort(stations, [](const Station& a, const Station& b) { return a.passed[0] < b.passed[0]; });
  return stations;
}

MiddleCurve draw_middle(const std::array<BorderPath, 2>& borders, const Station& from, const Station& to,
                        Vec3 first, Vec3 last) {
  MiddleCurve middle;
  for (int side = 0; side < 2; ++side)
    middle.edges[side] = borders[side].at(0.5 * (from.passed[side] + to.passed[side])).edge;
  for (int intervals = fewest_points;; intervals *= 2) {
    // Every other one is not on the curve but tells how well it follows.
    Middles fine = sample_middles(borders, from, to, middle.edges, 2 * intervals);
    shift_ends(fine.points, first, last);
    std::vector<double> passed{0};
    for (std::size_t i = 1; i < fine.points.size(); ++i)
      passed.push_back(passed.back() + distance(fine.points[i - 1], fine.points[i]));
    std::vector<Vec3> points;
    std::vector<double> at;
    for (std::size_t i = 0; i < fine.points.size(); i += 2) {
      points.push_back(fine.points[i]);
      at.push_back(passed[i]);
    }
    middle.curve = interpolate(points, at);
    double error = 0;
    for (std::size_t i = 1; i < fine.points.size(); i += 2)
      error = std::max(error, middle.curve->Value(passed[i]).Distance(to_gp(fine.points[i])));
    if (error > middle_error * fine.width && intervals < most_points) continue;
    middle.parameters = std::move(passed);
    middle.border_parameters = std::move(fine.parameters);
    return middle;
  }
}

Vec3 EndMove::operator()(Vec3 point) const {
  const double left = 1 - distance(point, from) / radius;
  return left > 0 ? std::pow(left, fading) * by : Vec3{};
}

Handle(Geom_Curve) move_ends(const GeomAdaptor_Curve& curve, const EndMove& first, const EndMove& last) {
  const double low = curve.FirstParameter(), high = curve.LastParameter();
  const auto value = [&](double t) { return to_vec(curve.Value(t)); };
  if (curve.GetType() == GeomAbs_Line)
    return straight(value(low) + first.by, value(high) + last.by, low, high);
  const auto moved = [&](double t) { return first(value(t)) + last(value(t)); };
  const Handle(Geom_BSplineCurve) spline = as_spline(curve);
  if (spline.IsNull()) {
    constexpr int intervals = 256;  // of a circle or an ellipse, whose interpolation then errs by 1e-9 of it
    std::vector<Vec3> points;
    std::vector<double> at;
    for (int i = 0; i <= intervals; ++i) {
      at.push_back(i == intervals ? high : low + (high - low) * i / intervals);
      points.push_back(value(at.back()) + moved(at.back()));
    }
    return interpolate(points, at);
  }
  TColStd_Array1OfReal knots(1, spline->NbPoles() + spline->Degree() + 1);
  spline->KnotSequence(knots);
  for (int i = 1; i <= spline->NbPoles(); ++i) {
    const Vec3 by = moved(greville(knots, i, spline->Degree()));
    spline->SetPole(i, spline->Pole(i).Translated(gp_Vec(by.x, by.y, by.z)));
  }
  return Handle(Geom_Curve)(spline);
}

}  // namespace aeroloom::cad
