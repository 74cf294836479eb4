#include "volume/core/core_squares.hpp"

#include <stdexcept>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// A square in its plane: the edge along the next axis lies along (1, 0).
struct Plane {
  double length, x, y;  ///< of the one edge; of the other

  Plane(Vec3 u, Vec3 v)
      : length(geometry::norm(u)), x(dot(u, v) / length), y(geometry::norm(cross(u, v)) / length) {}
  std::array<double, 2> at(int place) const {
    const auto [i, j] = square_places[place];
    return {i * length + j * x, j * y};
  }
};

bool are_in_line(int a, int b, int c) {
  const auto& [p, q, r] = std::tie(square_places[a], square_places[b], square_places[c]);
  return (q[0] - p[0]) * (r[1] - p[1]) == (q[1] - p[1]) * (r[0] - p[0]);
}

/// Whether a place lies in the circle through three others, in cyclic order.
bool is_in_circle(const Plane& plane, const std::array<int, 3>& circle, int place) {
  const auto d = plane.at(place);
  double rows[3][3];
  for (int k = 0; k < 3; ++k) {
    const auto p = plane.at(circle[k]);
    rows[k][0] = p[0] - d[0];
    rows[k][1] = p[1] - d[1];
    rows[k][2] = rows[k][0] * rows[k][0] + rows[k][1] * rows[k][1];
  }
  const auto& [a, b, c] = rows;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
             a[2] * (b[0] * c[1] - b[1] * c[0]) >
         0;
}

std::vector<CoreSquares::Triangle> triangulate(const Plane& plane, SquarePattern pattern) {
  std::vector<int> places;
  for (int k = 0; k < 8; ++k) {
    if (k % 2 == 0 || (pattern >> k / 2 & 1)) places.push_back(k);
  }
  std::vector<CoreSquares::Triangle> triangles;
  const std::size_t count = places.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        const std::array<int, 3> corners{places[i], places[j], places[k]};
        if (are_in_line(corners[0], corners[1], corners[2])) continue;
        bool empty = true;
        for (const int p : places) {
          if (p != corners[0] && p != corners[1] && p != corners[2])
            empty = empty && !is_in_circle(plane, corners, p);
        }
        if (!empty) continue;
        triangles.push_back({static_cast<std::uint8_t>(corners[0]), static_cast<std::uint8_t>(corners[1]),
                             static_cast<std::uint8_t>(corners[2])});
      }
    }
  }
  if (triangles.size() + 2 != count)
    throw std::logic_error("a square of the lattice has no one triangulation");
  return triangles;
}

}  // namespace

CoreSquares::CoreSquares(const LatticeFrame& frame) {
  const std::array<Vec3, 3> steps = frame.steps();
  for (int axis = 0; axis < 3; ++axis) {
    const Plane plane(steps[(axis + 1) % 3], steps[(axis + 2) % 3]);
    for (SquarePattern pattern = 0; pattern < square_patterns; ++pattern)
      _triangles[axis][pattern] = triangulate(plane, pattern);
  }
}

}  // namespace aeroloom::volume
