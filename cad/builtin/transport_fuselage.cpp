#include "cad/builtin/transport_components.hpp"

#include <cmath>
#include <numbers>

#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

namespace aeroloom::cad {
namespace {

// The shape is a designer's choice, that of no aircraft; what is measured on it stands in docs/ with its
// hash, so that these numbers stay.

constexpr int spline_degree = 3;
constexpr int nose_stations = 6;          // over a quarter of an ellipse
constexpr double nose_tip_radius = 0.12;  // over the cabin's, of the control points that round the tip
constexpr double end_rounding = 0.6;      // over the radius of the tail's end, likewise
constexpr int fewest_cabin_stations = 3;  // with the front's four of one radius: a cylindrical span
constexpr int tail_stations = 8;
constexpr double cabin_station_spacing = 1.5;  // in radii
constexpr double tail_end_radius = 0.14;       // over the cabin's
constexpr double tail_shape = 1.6;             // exponent of the taper; 1 is a cone

/// The lines that divide the fuselage into belly, sides and crown, in degrees from the right wing upward: off
/// the wings below the axis, the tailplane above it and the fin on top.
constexpr double sectors[][2] = {{-120, -60}, {-60, 55}, {55, 125}, {125, 240}};

}  // namespace

Fuselage::Fuselage(const TransportDimensions& d) {
  const double radius = 0.5 * d.fuselage_diameter, tail_start = d.fuselage_length - d.tail_length;
  // The first two stations lie in the plane of the tip, the last two in that of the end: round, no needle.
  _stations.push_back({0, 0, 0});
  _stations.push_back({0, nose_tip_radius * radius, 0});
  for (int i = 1; i <= nose_stations; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / nose_stations;
    _stations.push_back({d.nose_length * (1 - std::cos(angle)), radius * std::sin(angle), 0});
  }
  const auto cabin_front = static_cast<double>(_stations.size() - 1);
  const double cabin = tail_start - d.nose_length;
  const int cabin_stations = std::max(
      fewest_cabin_stations, static_cast<int>(std::lround(cabin / (cabin_station_spacing * radius))));
  for (int i = 1; i <= cabin_stations; ++i) {
    _stations.push_back({d.nose_length + cabin * i / cabin_stations, radius, 0});
  }
  const auto cabin_end = static_cast<double>(_stations.size() - 1);
  const double end_radius = tail_end_radius * radius, end_x = d.fuselage_length - 0.5 * end_radius;
  for (int i = 1; i <= tail_stations; ++i) {
    const double s = static_cast<double>(i) / tail_stations, taper = std::pow(s, tail_shape);
    _stations.push_back({tail_start + s * (end_x - tail_start), radius + taper * (end_radius - radius),
                         taper * d.tail_upsweep});
  }
  _stations.push_back({d.fuselage_length, end_rounding * end_radius, d.tail_upsweep});
  _stations.push_back({d.fuselage_length, 0, d.tail_upsweep});
  // With knots 0, 1, 2, ... the control point i rules around the parameter i - 1.
  const auto spans = static_cast<double>(_stations.size() - spline_degree);
  _breaks = {0, cabin_front - 1, cabin_end - 1, spans};
}

Component Fuselage::make_component() const {
  const int count = static_cast<int>(_stations.size()), spans = count - spline_degree;
  TColStd_Array1OfReal u_knots(1, 2), v_knots(1, spans + 1);
  TColStd_Array1OfInteger u_multiplicities(1, 2), v_multiplicities(1, spans + 1);
  u_knots(1) = 0, u_knots(2) = 1;
  u_multiplicities.Init(3), v_multiplicities.Init(1);
  v_multiplicities(1) = v_multiplicities(spans + 1) = spline_degree + 1;
  for (int i = 0; i <= spans; ++i) v_knots(i + 1) = i;
  std::vector<NamedFace> faces;
  for (const auto& sector : sectors) {
    const double middle = 0.5 * (sector[0] + sector[1]) * std::numbers::pi / 180;
    const double half = 0.5 * (sector[1] - sector[0]) * std::numbers::pi / 180;
    TColgp_Array2OfPnt poles(1, 3, 1, count);
    TColStd_Array2OfReal weights(1, 3, 1, count);
    for (int i = 0; i < 3; ++i) {
      const double angle = middle + (i - 1) * half, weight = i == 1 ? std::cos(half) : 1;
      for (int j = 0; j < count; ++j) {
        const Station& s = _stations[j];
        poles(i + 1, j + 1) =
            gp_Pnt(s.x, s.radius / weight * std::cos(angle), s.z + s.radius / weight * std::sin(angle));
        weights(i + 1, j + 1) = weight;
      }
    }
    const Handle(Geom_BSplineSurface) surface = new Geom_BSplineSurface(
        poles, weights, u_knots, v_knots, u_multiplicities, v_multiplicities, 2, spline_degree);
    for (std::size_t k = 0; k + 1 < _breaks.size(); ++k) {
      const auto part = Handle(Geom_BSplineSurface)::DownCast(surface->Copy());
      part->Segment(0, 1, _breaks[k], _breaks[k + 1]);
      faces.push_back({whole_face(part), "fuselage"});
    }
  }
  return sew_component(faces);
}

Fuselage::Station Fuselage::evaluate(double parameter) const {
  // De Boor's algorithm on the clamped uniform knots.
  const int spans = static_cast<int>(_stations.size()) - spline_degree;
  const int span = std::clamp(static_cast<int>(parameter), 0, spans - 1);
  const auto knot = [&](int i) {
    return std::clamp(static_cast<double>(i - spline_degree), 0.0, static_cast<double>(spans));
  };
  Station d[spline_degree + 1];
  for (int i = 0; i <= spline_degree; ++i) d[i] = _stations[span + i];
  for (int round = 1; round <= spline_degree; ++round) {
    for (int i = spline_degree; i >= round; --i) {
      const double low = knot(span + i), high = knot(span + i + spline_degree + 1 - round);
      const double t = (parameter - low) / (high - low);
      d[i] = {(1 - t) * d[i - 1].x + t * d[i].x, (1 - t) * d[i - 1].radius + t * d[i].radius,
              (1 - t) * d[i - 1].z + t * d[i].z};
    }
  }
  return d[spline_degree];
}

double Fuselage::depth(Vec3 point) const {
  constexpr int bisections = 60;  // down to the last bit of the parameter
  double low = 0, high = _breaks.back();
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (evaluate(middle).x < point.x ? low : high) = middle;
  }
  const Station station = evaluate(low);
  const double outside = std::max(-point.x, point.x - _stations.back().x);
  return std::min(station.radius - std::hypot(point.y, point.z - station.z), -outside);
}

}  // namespace aeroloom::cad
