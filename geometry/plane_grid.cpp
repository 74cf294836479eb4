#include "geometry/plane_grid.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::geometry {
namespace {

/// Cells are entered a little early, in parts of a cell, so that rounding loses none.
constexpr double margin = 1e-6;

}  // namespace

PlaneGrid::PlaneGrid(const std::vector<Vec2>& points,
                     const std::vector<std::array<std::int32_t, 3>>& triangles) {
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Vec2 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double width = std::max(high.x - low.x, 1e-300), height = std::max(high.y - low.y, 1e-300);
  const double cells = 2.0 * static_cast<double>(triangles.size()) + 1;
  _low = low;
  _cell = std::max(std::sqrt(width * height / cells), std::max(width, height) / cells);
  _columns = static_cast<std::int32_t>(width / _cell) + 1;
  _rows = static_cast<std::int32_t>(height / _cell) + 1;

  const auto for_each_entry = [&](auto visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t];
      if (!(cross(points[b] - points[a], points[c] - points[a]) > 0)) continue;
      for_each_cell({points[a], points[b], points[c]},
                    [&](std::int32_t cell) { visit(cell, static_cast<std::int32_t>(t)); });
    }
  };
  _begin.assign(static_cast<std::size_t>(_columns) * _rows + 1, 0);
  for_each_entry([&](std::int32_t cell, std::int32_t) { ++_begin[cell + 1]; });
  for (std::size_t i = 1; i < _begin.size(); ++i) _begin[i] += _begin[i - 1];
  _triangles.resize(_begin.back());
  std::vector<std::int32_t> next(_begin.begin(), _begin.end() - 1);
  for_each_entry([&](std::int32_t cell, std::int32_t t) { _triangles[next[cell]++] = t; });
}

std::array<std::int32_t, 2> PlaneGrid::cell_of(Vec2 point) const {
  const auto index = [this](double offset, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(std::floor(offset / _cell), 0.0, count - 1.0));
  };
  return {index(point.x - _low.x, _columns), index(point.y - _low.y, _rows)};
}

std::span<const std::int32_t> PlaneGrid::triangles_in(std::int32_t column, std::int32_t row) const {
  const std::int32_t cell = row * _columns + column;
  return {_triangles.data() + _begin[cell], _triangles.data() + _begin[cell + 1]};
}

template <class Visit>
void PlaneGrid::for_each_cell(const std::array<Vec2, 3>& corners, Visit visit) const {
  const double bottom = std::min({corners[0].y, corners[1].y, corners[2].y});
  const double top = std::max({corners[0].y, corners[1].y, corners[2].y});
  const std::int32_t last_row = cell_of({_low.x, top})[1];
  for (std::int32_t row = cell_of({_low.x, bottom})[1]; row <= last_row; ++row) {
    // The least and largest x of the triangle within the row.
    const double from = _low.y + (row - margin) * _cell, to = _low.y + (row + 1 + margin) * _cell;
    double left = 1e300, right = -1e300;
    const auto include = [&](double x) { left = std::min(left, x), right = std::max(right, x); };
    for (int i = 0; i < 3; ++i) {
      const Vec2 a = corners[i], b = corners[(i + 1) % 3];
      const double least = std::min(a.y, b.y), most = std::max(a.y, b.y);
      if (most < from || least > to) continue;
      if (least == most) {
        include(a.x), include(b.x);
        continue;
      }
      for (const double y : {std::clamp(from, least, most), std::clamp(to, least, most)}) {
        include(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
      }
    }
    if (left > right) continue;
    const std::int32_t last = cell_of({right + margin * _cell, bottom})[0];
    for (std::int32_t column = cell_of({left - margin * _cell, bottom})[0]; column <= last; ++column) {
      visit(row * _columns + column);
    }
  }
}

}  // namespace aeroloom::geometry
