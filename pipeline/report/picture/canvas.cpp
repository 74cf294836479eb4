#include "pipeline/report/picture/canvas.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace aeroloom::picture {
namespace {

/// Where the samples of a pixel lie: no two of them in one column or row, so that borders in any direction
/// get as many steps as there are samples.
constexpr std::array<std::array<double, 2>, Canvas::samples> sample_places = {
    {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}};

struct Range {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
};

/// The columns that a convex polygon covers between two heights; empty where it has nothing there.
Range columns_between(std::span<const ScreenPoint> polygon, double top, double bottom) {
  Range columns;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    ScreenPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (a.y > b.y) std::swap(a, b);
    if (b.y < top || a.y > bottom) continue;
    const double rise = b.y - a.y;
    const auto column_at = [&](double y) { return rise > 0 ? a.x + (y - a.y) / rise * (b.x - a.x) : a.x; };
    columns.add(a.y >= top ? a.x : column_at(top));
    columns.add(b.y <= bottom ? b.x : column_at(bottom));
  }
  return columns;
}

/// Calls visit(x, y) for the pixels of the window near a convex polygon.
template <class Visit>
void for_each_pixel(std::span<const ScreenPoint> polygon, double margin, const Window& window,
                    const Visit& visit) {
  Range rows;
  for (const ScreenPoint& p : polygon) rows.add(p.y);
  const auto clamped = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(std::floor(value), double(low), double(high)));
  };
  const int right = window.left + window.width, bottom = window.top + window.height;
  if (!(rows.high + margin >= window.top && rows.low - margin <= bottom)) return;
  for (int y = clamped(rows.low - margin, window.top, bottom),
           end = clamped(rows.high + margin, -1, bottom - 1);
       y <= end; ++y) {
    const Range columns = columns_between(polygon, y - margin, y + 1 + margin);
    if (!(columns.high + margin >= window.left && columns.low - margin < right)) continue;
    const int last = clamped(columns.high + margin, -1, right - 1);
    for (int x = clamped(columns.low - margin, window.left, right); x <= last; ++x) visit(x, y);
  }
}

/// An edge, by the area beside it: the same number with the other sign on the way back.
class EdgeSide {
public:
  EdgeSide() = default;
  EdgeSide(const ScreenPoint& a, const ScreenPoint& b) {
    const bool ascending = a.x < b.x || (a.x == b.x && a.y < b.y);
    const ScreenPoint &p = ascending ? a : b, &q = ascending ? b : a;
    _x = p.x, _y = p.y, _dx = q.x - p.x, _dy = q.y - p.y;
    _sign = ascending ? 1 : -1;
  }
  /// Twice the area left of the way from a to b, up to a point.
  double area(double x, double y) const { return _sign * (_dx * (y - _y) - _dy * (x - _x)); }
  void flip() { _sign = -_sign; }

private:
  double _x = 0, _y = 0, _dx = 0, _dy = 0, _sign = 1;
};

/// A number that ascends with the value.
std::uint32_t ascending_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits & 0x80000000U ? ~bits : bits | 0x80000000U;
}

double distance_of(const ScreenPoint& a, const ScreenPoint& b) {
  return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

}  // namespace

Canvas::Canvas(int width, int height)
    : _width(width),
      _height(height),
      _window{0, 0, width, height},
      _nearest(std::numeric_limits<double>::lowest()),
      _samples(static_cast<std::size_t>(width) * height * samples, nothing) {}

void Canvas::put(std::uint64_t& sample, double depth, Colour colour) const {
  if (depth < _nearest) return;
  const std::uint64_t fragment = std::uint64_t{ascending_bits(static_cast<float>(depth))} << 32 |
                                 std::uint64_t{colour.red} << 16 | std::uint64_t{colour.green} << 8 |
                                 colour.blue;
  sample = std::min(sample, fragment);
}

void Canvas::draw_triangle(const std::array<ScreenPoint, 3>& corners, const TriangleStyle& style) {
  std::array<EdgeSide, 3> edges;
  std::array<double, 3> lengths;
  for (int i = 0; i < 3; ++i) {
    edges[i] = {corners[i], corners[(i + 1) % 3]};
    lengths[i] = distance_of(corners[i], corners[(i + 1) % 3]);
  }
  const double area = edges[0].area(corners[2].x, corners[2].y);
  if (!(std::abs(area) > 0)) return;
  if (area < 0) {
    for (EdgeSide& edge : edges) edge.flip();
  }
  for_each_pixel(corners, 0, _window, [&](int x, int y) {
    std::uint64_t* pixel = row(y) + static_cast<std::size_t>(x) * samples;
    for (int s = 0; s < samples; ++s) {
      const double px = x + sample_places[s][0], py = y + sample_places[s][1];
      std::array<double, 3> sides;  // of the edge from corner i
      for (int i = 0; i < 3; ++i) sides[i] = edges[i].area(px, py);
      if (sides[0] < 0 || sides[1] < 0 || sides[2] < 0) continue;
      const double sum = sides[0] + sides[1] + sides[2];
      if (!(sum > 0)) continue;
      const double depth =
          (sides[1] * corners[0].depth + sides[2] * corners[1].depth + sides[0] * corners[2].depth) / sum;
      double opacity = 0;
      for (int i = 0; i < 3; ++i) {
        if (style.line_opacity[i] <= 0 || !(lengths[i] > 0)) continue;
        const double inside = 0.5 * style.line_width - sides[i] / lengths[i];
        opacity = std::max(opacity, style.line_opacity[i] * std::clamp(2 * inside + 0.5, 0.0, 1.0));
      }
      put(pixel[s], depth, opacity > 0 ? mix(style.fill, style.line, opacity) : style.fill);
    }
  });
}

void Canvas::draw_line(ScreenPoint a, ScreenPoint b, double width, Colour colour, double raised) {
  const std::array<ScreenPoint, 2> ends = {a, b};
  const double half = 0.5 * width, dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  for_each_pixel(ends, half, _window, [&](int x, int y) {
    std::uint64_t* pixel = row(y) + static_cast<std::size_t>(x) * samples;
    for (int s = 0; s < samples; ++s) {
      const double px = x + sample_places[s][0] - a.x, py = y + sample_places[s][1] - a.y;
      const double along = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0.0;
      const double ox = px - along * dx, oy = py - along * dy;
      if (!(ox * ox + oy * oy <= half * half)) continue;
      put(pixel[s], a.depth + along * (b.depth - a.depth) - raised, colour);
    }
  });
}

}  // namespace aeroloom::picture
