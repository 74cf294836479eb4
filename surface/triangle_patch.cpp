#include "surface/triangle_patch.hpp"

#include "surface/front.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// The flat triangle and the way back to space.
class Blend {
public:
  explicit Blend(const std::array<PatchSide, 3>& sides) : _sides(sides) {
    for (int k = 0; k < 3; ++k) {
      _corners[k] = sides[k].points.front();
      _fractions[k] = fractions_of(sides[k].points);
    }
    const double ab = distance(_corners[0], _corners[1]), ac = distance(_corners[0], _corners[2]);
    const Vec3 along = (_corners[1] - _corners[0]) / ab;
    const double x = dot(_corners[2] - _corners[0], along);
    _plane = {Vec2{0, 0}, Vec2{ab, 0}, Vec2{x, std::sqrt(std::max(0.0, ac * ac - x * x))}};
  }

  Vec2 plane_point(int side, std::size_t i) const {
    const double f = _fractions[side][i];
    return (1 - f) * _plane[side] + f * _plane[(side + 1) % 3];
  }

  Vec3 to_space(Vec2 p) const {
    const double area = cross(_plane[1] - _plane[0], _plane[2] - _plane[0]);
    std::array<double, 3> weight;
    for (int k = 0; k < 3; ++k) {
      const Vec2 b = _plane[(k + 1) % 3], c = _plane[(k + 2) % 3];
      weight[k] = std::clamp(cross(b - p, c - p) / area, 0.0, 1.0);
    }
    Vec3 q = weight[0] * _corners[0] + weight[1] * _corners[1] + weight[2] * _corners[2];
    for (int k = 0; k < 3; ++k) {
      const double near = weight[k] + weight[(k + 1) % 3];
      if (_sides[k].straight || near <= 0) continue;
      q += near * near * displacement(k, weight[(k + 1) % 3] / near);
    }
    return q;
  }

private:
  static std::vector<double> fractions_of(const std::vector<Vec3>& points) {
    std::vector<double> fractions{0};
    for (std::size_t i = 1; i < points.size(); ++i)
      fractions.push_back(fractions.back() + distance(points[i - 1], points[i]));
    for (double& f : fractions) f /= fractions.back();
    fractions.back() = 1;
    return fractions;
  }

  /// How far the curve is from its chord.
  Vec3 displacement(int side, double t) const {
    const auto& f = _fractions[side];
    const auto& x = _sides[side].points;
    const auto above = std::upper_bound(f.begin() + 1, f.end() - 1, t);
    const auto i = static_cast<std::size_t>(above - f.begin());
    const double s = std::clamp((t - f[i - 1]) / (f[i] - f[i - 1]), 0.0, 1.0);
    const Vec3 on_curve = (1 - s) * x[i - 1] + s * x[i];
    return on_curve - ((1 - t) * x.front() + t * x.back());
  }

  const std::array<PatchSide, 3>& _sides;
  std::array<Vec3, 3> _corners;
  std::array<Vec2, 3> _plane;
  std::array<std::vector<double>, 3> _fractions;
};

}  // namespace

PatchMesh fill_triangle(const std::array<PatchSide, 3>& sides, const std::function<double(Vec3)>& size) {
  const Blend blend(sides);
  FrontInput boundary;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i + 1 < sides[k].points.size(); ++i)
      boundary.points.push_back(blend.plane_point(k, i));
  }
  const auto count = static_cast<std::int32_t>(boundary.points.size());
  for (std::int32_t i = 0; i < count; ++i) boundary.edges.push_back({i, (i + 1) % count});
  FrontResult front = fill_front(boundary, [&](Vec2 p, std::int32_t&) { return size(blend.to_space(p)); });
  PatchMesh patch;
  for (std::size_t i = static_cast<std::size_t>(count); i < front.points.size(); ++i)
    patch.inner.push_back(blend.to_space(front.points[i]));
  patch.triangles = std::move(front.triangles);
  return patch;
}

}  // namespace aeroloom::surface
