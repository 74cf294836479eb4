/// Lengths of a curve in the metric of a size function.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace aeroloom::surface {

/// The integral of a positive density over a parameter interval, and its inverse: with density = |c'(t)| /
/// h(c(t)) it tells how many elements fit on the curve c, and where their ends lie. Adaptive Gauss-Legendre
/// quadrature by spans of less than half an element; inside a span the density is the parabola through its
/// three values, whose integral is the quadrature's.
class MetricLength {
public:
  using Density = std::function<double(double)>;

  /// `breaks`: the interval split where the density is not smooth; ascending, ends included.
  MetricLength(Density density, const std::vector<double>& breaks);

  double total() const { return _total; }
  /// The parameter up to which the integral has the given value in [0, total()].
  double parameter_at(double value) const;

private:
  static constexpr int points = 3;  // of the quadrature
  /// A part of the interval, accepted.
  struct Span {
    double from, to;  // parameters
    std::array<double, points> densities;
    double before;  // the integral up to its start

    double whole() const;
    /// The parabola's integral over the part [from, from + s (to - from)].
    double up_to(double s) const;
  };

  Span measure(double from, double to) const;
  void add_span(const Span& span, int depth);

  Density _density;
  std::vector<Span> _spans;  // ascending
  double _total = 0;
};

/// The parameters that divide the interval into `segments` parts of equal integral, ends excluded.
std::vector<double> equal_parts(const MetricLength& length, int segments);

}  // namespace aeroloom::surface
