/// Lengths of a curve in the metric of a size field.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace aeroloom::surface {

/// The integral of a positive density over a parameter interval, and its inverse. With the density |c'(t)| /
/// h(c(t)) it counts the elements on the curve c and places their ends. Quadrature is adaptive
/// (Gauss-Legendre) with spans of less than half an element. Inside a span the density is the parabola
/// through its three values, which has the integral of the quadrature.
class MetricLength {
public:
  using Density = std::function<double(double)>;

  /// `breaks`: the ends of the interval and the parameters where the density is not smooth; ascending.
  MetricLength(Density density, const std::vector<double>& breaks);

  double total() const { return _total; }
  /// The parameter up to which the integral has the given value, from 0 to total().
  double parameter_at(double value) const;

private:
  static constexpr int points = 3;  // of the quadrature
  /// An accepted subinterval.
  struct Span {
    double from, to;  // parameters
    std::array<double, points> densities;
    double before;  // the integral up to its start

    double whole() const;
    /// The parabola's integral over [from, from + s (to - from)].
    double up_to(double s) const;
  };

  Span measure(double from, double to) const;
  void add_span(const Span& span, int depth);

  Density _density;
  std::vector<Span> _spans;  // ascending
  double _total = 0;
};

/// The inner parameters that divide the interval into `segments` parts of equal integral.
std::vector<double> equal_parts(const MetricLength& length, int segments);

}  // namespace aeroloom::surface
