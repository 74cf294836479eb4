/// Lengths of a curve in the metric of a size function.
#pragma once

#include <functional>
#include <vector>

namespace aeroloom::surface {

/// The integral of a positive density over a parameter interval, and its inverse: with density = |c'(t)| /
/// h(c(t)) it tells how many elements fit on the curve c, and where their ends lie. Adaptive Gauss-Legendre
/// quadrature, so kinks of the density cost depth, not accuracy.
class MetricLength {
public:
  using Density = std::function<double(double)>;

  /// `breaks`: the interval split where the density is not smooth; ascending, ends included.
  MetricLength(Density density, const std::vector<double>& breaks);

  double total() const { return _cumulated.back(); }
  /// The parameter up to which the integral has the given value in [0, total()].
  double parameter_at(double value) const;

private:
  double gauss(double from, double to) const;
  void add_span(double from, double to, double whole, int depth);

  Density _density;
  std::vector<double> _parameters;  // ends of the accepted spans, ascending
  std::vector<double> _cumulated;   // the integral up to each
};

/// The parameters that divide the interval into `segments` parts of equal integral, ends excluded.
std::vector<double> equal_parts(const MetricLength& length, int segments);

}  // namespace aeroloom::surface
