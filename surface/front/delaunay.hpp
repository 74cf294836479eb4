/// Constrained Delaunay triangulation in the plane. The advancing front places its points in it.
///
/// Points are inserted by the cavity operator (Bowyer, Comput. J. 24, 1981, doi:10.1093/comjnl/24.2.162;
/// Watson, ibid., doi:10.1093/comjnl/24.2.167). Boundary edges are recovered by flips (Sloan, Comput. Struct.
/// 47, 1993, doi:10.1016/0045-7949(93)90239-A). All signs are exact, so the triangulation is valid after
/// every step.
#pragma once

#include "geometry/predicates.hpp"
#include "geometry/triangle_links.hpp"
#include "geometry/vec.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::front {

/// Bounds of the rounding errors of the two determinants, over the sums of the magnitudes of their terms: (3
/// + 16 e) e and (10 + 96 e) e with e = 2^-53. They are ccwerrboundA and iccerrboundA of Shewchuk (1997),
/// cited below.
inline constexpr double orientation_error = 3.3306690738754716e-16, circle_error = 1.1102230246251577e-15;

/// geometry::orient2d, with a floating-point filter before it (Shewchuk, Discrete Comput. Geom. 18, 1997,
/// doi:10.1007/PL00009321).
inline int orientation(geometry::Vec2 a, geometry::Vec2 b, geometry::Vec2 c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double bound = orientation_error * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return geometry::orient2d(a, b, c);
}

/// geometry::in_circle, with the filter of the same paper before it.
inline int circle_side(geometry::Vec2 a, geometry::Vec2 b, geometry::Vec2 c, geometry::Vec2 d) {
  const double adx = a.x - d.x, ady = a.y - d.y, bdx = b.x - d.x, bdy = b.y - d.y, cdx = c.x - d.x,
               cdy = c.y - d.y;
  const double bc = bdx * cdy, cb = cdx * bdy, ca = cdx * ady, ac = adx * cdy, ab = adx * bdy, ba = bdx * ady;
  const double aa = adx * adx + ady * ady, bb = bdx * bdx + bdy * bdy, cc = cdx * cdx + cdy * cdy;
  const double determinant = aa * (bc - cb) + bb * (ca - ac) + cc * (ab - ba);
  const double permanent = (std::abs(bc) + std::abs(cb)) * aa + (std::abs(ca) + std::abs(ac)) * bb +
                           (std::abs(ab) + std::abs(ba)) * cc;
  const double bound = circle_error * permanent;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return geometry::in_circle(a, b, c, d);
}

/// Number of vertices of the box around all points. They are numbered after the given points.
inline constexpr std::int32_t box_corners = 4;

/// Triangulates points inside a box of four extra vertices. So every given vertex has a closed fan of
/// triangles.
class Delaunay {
public:
  /// The Delaunay triangulation of the points. Vertices: the points in their order, then the four of the box.
  explicit Delaunay(std::span<const geometry::Vec2> points);
  /// Whether two points were equal. The triangulation then lacks the second one.
  bool has_duplicates() const { return _duplicates; }

  std::vector<geometry::Vec2> points;
  geometry::TriangleLinks mesh;

  /// Makes (a, b) an edge that no later step removes. False where a vertex or a fixed edge is in the way.
  bool recover(std::int32_t a, std::int32_t b);

  /// An edge of a cavity, with the inside on its left and the triangle on its other side.
  struct CavityEdge {
    std::int32_t origin, target;
    geometry::LinkedEdge outside;
    std::uint32_t flags;  ///< bit 0: fixed; bit 3: tagged
  };
  /// Collects the triangles whose circumcircle contains `point`. Starts from `start`, which must be one of
  /// them, and does not cross fixed edges. False where the point does not see the whole border of the cavity.
  bool find_cavity(geometry::Vec2 point, std::int32_t start);
  const std::vector<CavityEdge>& cavity() const { return _cavity; }
  /// Inserts the point of the last find_cavity() and returns its vertex. The new triangles have the order of
  /// cavity() and the vertices (origin, target, new). They inherit the user bits of `start` and are listed in
  /// created().
  std::int32_t fill_cavity();
  const std::vector<std::int32_t>& created() const { return _created; }

  /// Flips edges that are not Delaunay, starting from those on the stack, until there are none. Empties the
  /// stack.
  void restore(std::vector<geometry::LinkedEdge>& stack);
  /// Whether a flip makes the edge Delaunay. False for fixed edges.
  bool is_flip_wanted(geometry::LinkedEdge edge) const;

private:
  void add_box();
  void insert(std::int32_t vertex);
  geometry::LinkedEdge first_crossing(std::int32_t a, std::int32_t b, bool& blocked) const;
  bool collect_crossings(std::int32_t a, std::int32_t b, geometry::LinkedEdge first);
  void flip_crossings(std::int32_t a, std::int32_t b);
  std::int32_t locate(geometry::Vec2 point, std::int32_t start) const;
  bool sees_cavity(geometry::Vec2 point) const;
  void connect_cavity(std::int32_t vertex);

  struct VertexPair {
    std::int32_t a, b;
  };
  bool _duplicates = false;
  std::int32_t _last = 0;  // triangle made last
  std::int32_t _mark = 0;  // triangles of the current cavity carry it
  geometry::Vec2 _point;
  std::vector<CavityEdge> _cavity;
  std::vector<std::int32_t> _inside;  // triangles of the cavity
  std::vector<std::int32_t> _created;
  std::vector<geometry::LinkedEdge> _stack;
  std::vector<VertexPair> _crossings, _new_edges;
};

}  // namespace aeroloom::front
