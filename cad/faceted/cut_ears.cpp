#include "cad/faceted/plane_graph.hpp"
#include "geometry/predicates.hpp"

#include <cmath>
#include <utility>

namespace aeroloom::cad {

using geometry::orient2d;
using geometry::Vec2;
using geometry::Vec3;

namespace {

/// A polygon as a ring that loses its ears.
class EarRing {
public:
  EarRing(std::vector<std::int32_t> loop, std::span<const Vec2> places)
      : _loop(std::move(loop)), _places(places), _count(_loop.size()) {
    _next.resize(_count), _previous.resize(_count);
    for (std::size_t i = 0; i < _count; ++i) {
      _next[i] = (i + 1) % _count;
      _previous[i] = (i + _count - 1) % _count;
    }
  }

  std::optional<std::vector<geometry::TriangleCorners>> cut() {
    std::vector<geometry::TriangleCorners> ears;
    std::size_t at = 0, left = _count, looked_at = 0;
    while (left > 3) {
      if (looked_at++ > left) return {};
      if (!is_ear(at)) {
        at = _next[at];
        continue;
      }
      ears.push_back({_loop[_previous[at]], _loop[at], _loop[_next[at]]});
      _next[_previous[at]] = _next[at];
      _previous[_next[at]] = _previous[at];
      // The ears after one are cut from every second corner, which makes fewer needles than a fan.
      at = _next[_next[at]];
      --left;
      looked_at = 0;
    }
    if (turn(at) <= 0) return {};
    ears.push_back({_loop[_previous[at]], _loop[at], _loop[_next[at]]});
    return ears;
  }

private:
  Vec2 place(std::size_t i) const { return _places[_loop[i]]; }
  int turn(std::size_t i) const { return orient2d(place(_previous[i]), place(i), place(_next[i])); }

  bool is_ear(std::size_t at) const {
    if (turn(at) <= 0) return false;
    const std::size_t before = _previous[at], after = _next[at];
    const Vec2 a = place(before), b = place(at), c = place(after);
    for (std::size_t i = _next[after]; i != before; i = _next[i]) {
      const std::int32_t v = _loop[i];
      if (v == _loop[before] || v == _loop[at] || v == _loop[after]) continue;
      const Vec2 p = place(i);
      if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) return false;
    }
    return true;
  }

  std::vector<std::int32_t> _loop;
  std::span<const Vec2> _places;
  std::size_t _count;
  std::vector<std::size_t> _next, _previous;
};

}  // namespace

CoordinatePlane::CoordinatePlane(Vec3 normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  _first = (axis + 1) % 3, _second = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(_first, _second);
}

Vec3 polygon_area_vector(std::span<const Vec3> corners) {
  Vec3 sum;
  if (corners.empty()) return sum;
  const Vec3 base = corners.front();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += cross(corners[i] - base, corners[i + 1] - base);
  return sum;
}

std::optional<std::vector<geometry::TriangleCorners>> cut_ears(std::vector<std::int32_t> loop,
                                                               std::span<const Vec2> places) {
  if (loop.size() < 3) return {};
  return EarRing(std::move(loop), places).cut();
}

}  // namespace aeroloom::cad
