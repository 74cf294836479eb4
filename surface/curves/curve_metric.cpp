#include "surface/curves/curve_metric.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::surface {
namespace {

// Size fields have kinks; below these depths and errors they no longer show in the segments.
constexpr int least_depth = 2;
constexpr int largest_depth = 18;
constexpr double span_error = 1e-4;
constexpr double last_digit = 1e-15;  // of a fraction of a span, to which it is bisected

// Three-point Gauss-Legendre rule on [-1, 1]: x, 0, -x.
constexpr double outer_point = 0.774596669241483377, outer_weight = 5.0 / 9.0, middle_weight = 8.0 / 9.0;

}  // namespace

double MetricLength::Span::whole() const {
  return 0.5 * (to - from) * (outer_weight * (densities[0] + densities[2]) + middle_weight * densities[1]);
}

double MetricLength::Span::up_to(double s) const {
  // The parabola is a + b u + c u^2 over u in [-1, 1].
  const double a = densities[1], b = 0.5 * (densities[2] - densities[0]) / outer_point,
               c = (0.5 * (densities[0] + densities[2]) - densities[1]) / (outer_point * outer_point);
  const double u = 2 * s - 1;
  return 0.5 * (to - from) * (a * (u + 1) + b / 2 * (u * u - 1) + c / 3 * (u * u * u + 1));
}

MetricLength::MetricLength(Density density, const std::vector<double>& breaks)
    : _density(std::move(density)) {
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (breaks[i + 1] > breaks[i]) add_span(measure(breaks[i], breaks[i + 1]), 0);
  }
}

MetricLength::Span MetricLength::measure(double from, double to) const {
  const double middle = 0.5 * (from + to), away = 0.5 * (to - from) * outer_point;
  return {from, to, {_density(middle - away), _density(middle), _density(middle + away)}, 0};
}

void MetricLength::add_span(const Span& span, int depth) {
  const double middle = 0.5 * (span.from + span.to);
  const Span left = measure(span.from, middle), right = measure(middle, span.to);
  const double sum = left.whole() + right.whole();
  const bool accurate = std::abs(sum - span.whole()) <= span_error * std::max(1.0, sum);
  const bool short_enough = sum <= 1;
  if (depth < largest_depth && (depth < least_depth || !accurate || !short_enough)) {
    add_span(left, depth + 1);
    add_span(right, depth + 1);
    return;
  }
  for (Span half : {left, right}) {
    half.before = _total;
    _total += half.whole();
    _spans.push_back(half);
  }
}

double MetricLength::parameter_at(double value) const {
  const auto after = std::upper_bound(_spans.begin() + 1, _spans.end(), value,
                                      [](double v, const Span& span) { return v < span.before; });
  const Span& span = *(after - 1);
  const double target = value - span.before;
  double low = 0, high = 1;
  while (true) {
    const double s = 0.5 * (low + high);
    if (!(s > low && s < high) || high - low < last_digit) break;
    (span.up_to(s) > target ? high : low) = s;
  }
  return span.from + 0.5 * (low + high) * (span.to - span.from);
}

std::vector<double> equal_parts(const MetricLength& length, int segments) {
  std::vector<double> parameters;
  for (int i = 1; i < segments; ++i) parameters.push_back(length.parameter_at(length.total() * i / segments));
  return parameters;
}

}  // namespace aeroloom::surface
