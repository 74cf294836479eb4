/// Boundary loops for tests of the front.
#pragma once

#include "surface/front/front.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace aeroloom::front {

using geometry::Vec2;

inline constexpr double pi = std::numbers::pi;

inline void add_loop(FrontInput& input, const std::vector<Vec2>& loop) {
  const auto first = static_cast<std::int32_t>(input.points.size()),
             count = static_cast<std::int32_t>(loop.size());
  input.points.insert(input.points.end(), loop.begin(), loop.end());
  for (std::int32_t i = 0; i < count; ++i) input.edges.push_back({first + i, first + (i + 1) % count});
}

inline std::vector<Vec2> circle(Vec2 centre, double radius, int edges) {
  std::vector<Vec2> loop;
  for (int i = 0; i < edges; ++i) {
    const double angle = 2 * pi * i / edges;
    loop.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return loop;
}

inline std::vector<Vec2> reversed(std::vector<Vec2> loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

/// A polygon with its sides divided evenly into edges of about the given length.
inline std::vector<Vec2> polygon(const std::vector<Vec2>& corners, double edge) {
  std::vector<Vec2> loop;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    const int parts = std::max(1, static_cast<int>(std::lround(distance(a, b) / edge)));
    for (int k = 0; k < parts; ++k) loop.push_back(a + (double(k) / parts) * (b - a));
  }
  return loop;
}

inline std::vector<Vec2> rectangle(Vec2 low, Vec2 high, double edge) {
  return polygon({low, {high.x, low.y}, high, {low.x, high.y}}, edge);
}

}  // namespace aeroloom::front
