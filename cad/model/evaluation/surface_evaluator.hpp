/// Points and derivatives of a CAD surface. Seen by this folder only.
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

/// The parameter of the same point in [low, high], where points repeat after `period`; 0: they do not.
inline double wrap_parameter(double parameter, double low, double high, double period) {
  if (period == 0 || (parameter >= low && parameter <= high)) return parameter;
  return parameter - period * std::floor((parameter - low) / period);
}

/// Point and derivatives up to second order.
struct SurfaceJet {
  Vec3 point, du, dv, duu, duv, dvv;
};

/// A B-spline surface (rational or not) evaluated by its basis functions (Piegl and Tiller, The NURBS Book,
/// 1997, algorithms 2.2, A3.5 and A4.4). The CAD library expands a span to a polynomial whenever the span
/// changes, which scattered evaluation pays for each time.
class SplineSurface {
public:
  explicit SplineSurface(const Handle(Geom_BSplineSurface) & surface);

  /// Fills derivatives up to `order` (0, 1 or 2).
  SurfaceJet evaluate(Vec2 uv, int order) const;

private:
  static constexpr int max_count = 26;  // the CAD library's highest degree plus one

  /// One parameter direction.
  struct Direction {
    int degree = 1;
    double low = 0, high = 1, period = 0;
    std::vector<double> knots;  // flat, each as often as its multiplicity
    int poles = 0;

    /// Index of the knot span, the nearest one for parameters outside.
    int span(double parameter) const;
    double wrap(double parameter) const { return wrap_parameter(parameter, low, high, period); }
  };
  /// Basis functions that do not vanish on a span: [derivative][function].
  using Basis = std::array<std::array<double, max_count>, 3>;

  /// Of parameters in range; the sums are over as many coordinates as poles have.
  template <int order, int width>
  SurfaceJet sum(Vec2 uv) const;
  static void basis(const Direction& direction, int span, double parameter, int order, Basis& result);

  Direction _u, _v;
  bool _rational = false;
  std::vector<double> _poles;  // by u, then v: x y z, or wx wy wz w
};

/// Evaluates any surface: splines by SplineSurface, the others by the CAD library.
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
