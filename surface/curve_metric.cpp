#include "surface/curve_metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace aeroloom::surface {
namespace {

// Size fields have kinks at the faces of their octree cells; below these depths and errors they no longer
// show in the segments.
constexpr int least_depth = 2;
constexpr int largest_depth = 18;
constexpr double span_error = 1e-5;

// Three-point Gauss-Legendre rule on [-1, 1].
constexpr std::array<double, 3> gauss_points{-0.774596669241483377, 0.0, 0.774596669241483377};
constexpr std::array<double, 3> gauss_weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

}  // namespace

MetricLength::MetricLength(Density density, const std::vector<double>& breaks)
    : _density(std::move(density)) {
  _parameters.push_back(breaks.front());
  _cumulated.push_back(0);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (breaks[i + 1] > breaks[i]) add_span(breaks[i], breaks[i + 1], gauss(breaks[i], breaks[i + 1]), 0);
  }
}

double MetricLength::gauss(double from, double to) const {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (std::size_t i = 0; i < gauss_points.size(); ++i) {
    sum += gauss_weights[i] * _density(middle + half * gauss_points[i]);
  }
  return half * sum;
}

void MetricLength::add_span(double from, double to, double whole, int depth) {
  const double middle = 0.5 * (from + to);
  const double left = gauss(from, middle), right = gauss(middle, to);
  const bool accurate = std::abs(left + right - whole) <= span_error * std::max(1.0, left + right);
  const bool short_enough = left + right <= 1;
  if (depth >= largest_depth || (depth >= least_depth && accurate && short_enough)) {
    for (const auto& [end, part] : {std::pair{middle, left}, std::pair{to, right}}) {
      _parameters.push_back(end);
      _cumulated.push_back(_cumulated.back() + part);
    }
    return;
  }
  add_span(from, middle, left, depth + 1);
  add_span(middle, to, right, depth + 1);
}

double MetricLength::parameter_at(double value) const {
  const auto above = std::upper_bound(_cumulated.begin() + 1, _cumulated.end() - 1, value);
  const std::size_t i = static_cast<std::size_t>(above - _cumulated.begin()) - 1;
  const double start = _parameters[i], part = _cumulated[i + 1] - _cumulated[i];
  if (part <= 0) return start;
  // Newton's method, kept inside the bracket by bisection. The quadrature over the whole span differs a
  // little from `part` (the sum of halves of a finer rule), hence the normalisation.
  double low = start, high = _parameters[i + 1];
  const double target = (value - _cumulated[i]) * (gauss(low, high) / part);
  double t = start + (high - start) * std::clamp((value - _cumulated[i]) / part, 0.0, 1.0);
  for (int step = 0; step < 40 && high > low; ++step) {
    const double excess = gauss(start, t) - target;
    (excess > 0 ? high : low) = t;
    const double density = _density(t);
    double next = density > 0 ? t - excess / density : low;
    // Checked first: what is exact leaves the bracket, and would be bisected over and over.
    if (std::abs(next - t) <= 1e-13 * (_parameters.back() - _parameters.front())) break;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    t = next;
  }
  return t;
}

std::vector<double> equal_parts(const MetricLength& length, int segments) {
  std::vector<double> parameters;
  for (int i = 1; i < segments; ++i) parameters.push_back(length.parameter_at(length.total() * i / segments));
  return parameters;
}

}  // namespace aeroloom::surface
