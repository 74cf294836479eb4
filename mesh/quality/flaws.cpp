#include "mesh/quality/flaws.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

/// Values that are good, and from which on they are poor. Angles are those of the report's words. Faces are
/// good up to where OpenFOAM's checkMesh counts them. At 85 degrees the correction of a gradient is eleven
/// times the part along the line of centres. Skewness of 20 is the most that OpenFOAM's own generator allows
/// at boundaries. The others are chosen: columns of layers that lean and stairs between them stay good.
struct FlawBar {
  double good, poor;
};
constexpr std::array<FlawBar, flaw_count> flaw_bars = {
    {{15, 1}, {0.1, 0.005}, {30, 1000}, {70, 85}, {4, 20}}};

constexpr std::array<std::array<int, 3>, 4> others_of_corner = {{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace

std::string_view name_of(Flaw flaw) {
  constexpr std::array<std::string_view, flaw_count> names = {"smallest_angle", "shape", "size_jump",
                                                              "non_orthogonality", "skewness"};
  return names[static_cast<std::size_t>(flaw)];
}

double corner_shape(CellShape shape, const Vec3* p) {
  if (shape != CellShape::tetrahedron)
    return measure_cell(shape, p)[static_cast<std::size_t>(Measure::scaled_jacobian)];
  double most = -1;
  for (int corner = 0; corner < 4; ++corner) {
    const auto& next = others_of_corner[static_cast<std::size_t>(corner)];
    const Vec3 a = p[next[0]] - p[corner], b = p[next[1]] - p[corner], c = p[next[2]] - p[corner];
    const double lengths = norm(a) * norm(b) * norm(c);
    if (lengths > 0) most = std::max(most, dot(cross(a, b), c) / lengths);
  }
  return std::isfinite(most) ? most : 0;
}

double severity_of(Flaw flaw, double value) {
  constexpr double least = 1e-30;
  const FlawBar& bar = flaw_bars[static_cast<std::size_t>(flaw)];
  return std::log(std::max(value, least) / bar.good) / std::log(bar.poor / bar.good);
}

Verdict verdict_of(double severity) {
  return severity <= 0 ? Verdict::good : severity < 1 ? Verdict::fair : Verdict::poor;
}

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 3> names = {"good", "fair", "poor"};
  return names[static_cast<std::size_t>(verdict)];
}

bool is_worse(const FlawedCell& a, const FlawedCell& b) {
  return std::make_tuple(-a.severity, a.cell) < std::make_tuple(-b.severity, b.cell);
}

}  // namespace aeroloom::mesh
