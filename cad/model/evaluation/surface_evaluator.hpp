/// Points and derivatives of CAD surfaces. Internal to cad/.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>

namespace aeroloom::cad {

using geometry::Vec2;
using geometry::Vec3;

/// The parameter of the same point in [low, high]. `period` is that of the parameter, 0 if it has none.
inline double wrap_parameter(double parameter, double low, double high, double period) {
  if (period == 0 || (parameter >= low && parameter <= high)) return parameter;
  return parameter - period * std::floor((parameter - low) / period);
}

/// Point and derivatives up to second order.
struct SurfaceJet {
  Vec3 point, du, dv, duu, duv, dvv;
};

/// Evaluates B-spline surfaces, rational or not, by their basis functions (Piegl and Tiller, The NURBS Book,
/// 1997, algorithms 2.2, A3.5 and A4.4). The CAD library converts a span to a polynomial first, which is slow
/// for scattered points.
class SplineSurface {
public:
  explicit SplineSurface(const Handle(Geom_BSplineSurface) & surface);

  /// Fills derivatives up to `order` (0, 1 or 2).
  SurfaceJet evaluate(Vec2 uv, int order) const;

private:
  static constexpr int max_count = 26;  // highest degree in the CAD library plus one

  /// One parameter direction.
  struct Direction {
    int degree = 1;
    double low = 0, high = 1, period = 0;
    std::vector<double> knots;  // repeated by multiplicity
    int poles = 0;

    /// Index of the knot span; the nearest one for parameters outside.
    int span(double parameter) const;
    double wrap(double parameter) const { return wrap_parameter(parameter, low, high, period); }
  };
  /// The basis functions that are not zero on a span: [derivative][function].
  using Basis = std::array<std::array<double, max_count>, 3>;

  /// For parameters in range. `width` is the number of coordinates of a pole.
  template <int order, int width>
  SurfaceJet sum(Vec2 uv) const;
  static void basis(const Direction& direction, int span, double parameter, int order, Basis& result);

  Direction _u, _v;
  bool _rational = false;
  std::vector<double> _poles;  // by u, then v: x y z, or wx wy wz w
};

/// Evaluates any surface: splines by SplineSurface, others by the CAD library.
class SurfaceEvaluator {
public:
  SurfaceEvaluator() = default;
  explicit SurfaceEvaluator(const Handle(Geom_Surface) & surface);

  Vec3 point(Vec2 uv) const { return jet(uv, 0).point; }
  SurfaceJet jet(Vec2 uv, int order) const;
  const GeomAdaptor_Surface& adaptor() const { return _adaptor; }

private:
  GeomAdaptor_Surface _adaptor;
  std::optional<SplineSurface> _spline;
};

}  // namespace aeroloom::cad
