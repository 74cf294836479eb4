#include "surface/support_flips.hpp"

#include "surface/support_topology.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Triangles that turn by more than this (10 degrees) are not merged into one plane for a flip.
constexpr double coplanar_cosine = 0.985;

class Flipper {
public:
  explicit Flipper(Support& support) : _support(support), _twins(match_half_edges(support.triangles)) {}

  void run() {
    const HalfEdge count = static_cast<HalfEdge>(_twins.size());
    std::vector<HalfEdge> queue;
    std::vector<char> queued(count, 0);
    for (HalfEdge h = count - 1; h >= 0; --h) {
      if (_twins[h] > h) queue.push_back(h), queued[h] = 1;
    }
    // Angles of neighbours change a little with every flip on a curved support, so termination is enforced.
    for (std::int64_t left = 8 * static_cast<std::int64_t>(count); !queue.empty() && left > 0; --left) {
      const HalfEdge h = queue.back();
      queue.pop_back();
      queued[h] = 0;
      if (_twins[h] < 0 || !should_flip(h)) continue;
      flip(h);
      for (const HalfEdge around : {next_half_edge(h), previous_half_edge(h), next_half_edge(_twins[h]),
                                    previous_half_edge(_twins[h])}) {
        if (!queued[around]) queue.push_back(around), queued[around] = 1;
      }
    }
  }

private:
  Vec3 point(HalfEdge h) const { return _support.points[start_of(_support, h)]; }

  bool should_flip(HalfEdge h) const {
    const HalfEdge g = _twins[h];
    const HalfEdge apex = previous_half_edge(h), nadir = previous_half_edge(g);
    const std::int32_t c = start_of(_support, apex), d = start_of(_support, nadir);
    if (c == d || start_of(_support, h) != end_of(_support, g)) return false;
    return is_not_delaunay(point(h), point(g), point(apex), point(nadir)) && keeps_space(h, g) &&
           keeps_plane(h, g) && !are_joined(apex, d);
  }

  /// Whether the angles at c and d, opposite the edge ab, sum to more than 180 degrees.
  static bool is_not_delaunay(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const Vec3 ca = a - c, cb = b - c, da = a - d, db = b - d;
    const double sine = norm(cross(ca, cb)) * dot(da, db) + norm(cross(da, db)) * dot(ca, cb);
    return sine < -1e-9 * norm(ca) * norm(cb) * norm(da) * norm(db);
  }

  bool keeps_space(HalfEdge h, HalfEdge g) const {
    const Vec3 a = point(h), b = point(g), c = point(previous_half_edge(h)), d = point(previous_half_edge(g));
    const Vec3 old_first = cross(b - a, c - a), old_second = cross(a - b, d - b);
    const Vec3 normal = normalized(old_first + old_second);
    for (const Vec3 old : {old_first, old_second}) {
      if (dot(old, normal) < coplanar_cosine * norm(old)) return false;
    }
    for (const Vec3 now : {cross(d - a, c - a), cross(b - d, c - d)}) {
      if (!(dot(now, normal) > 0) || dot(now, normal) < coplanar_cosine * norm(now)) return false;
    }
    return true;
  }

  bool keeps_plane(HalfEdge h, HalfEdge g) const {
    const Vec2 a = start_uv(_support, h), b = end_uv(_support, h);
    if (!(a == end_uv(_support, g) && b == start_uv(_support, g))) return false;
    const Vec2 c = start_uv(_support, previous_half_edge(h)), d = start_uv(_support, previous_half_edge(g));
    return cross(d - a, c - a) * cross(b - d, c - d) > 0;
  }

  /// Whether the point at the start of half-edge `from` has an edge to `to`.
  bool are_joined(HalfEdge from, std::int32_t to) const {
    const auto meets = [&](HalfEdge h) {
      return end_of(_support, h) == to || end_of(_support, next_half_edge(h)) == to;
    };
    HalfEdge h = from;
    do {
      if (meets(h)) return true;
      h = _twins[previous_half_edge(h)];
    } while (h >= 0 && h != from);
    if (h == from) return false;
    for (h = _twins[from]; h >= 0; h = _twins[h]) {
      h = next_half_edge(h);
      if (meets(h)) return true;
    }
    return false;
  }

  /// Triangles (a,b,c), (b,a,d) become (a,d,c) and (d,b,c); half-edge h becomes the new diagonal d to c.
  void flip(HalfEdge h) {
    const HalfEdge g = _twins[h];
    const HalfEdge bc = next_half_edge(h), ca = previous_half_edge(h);
    const HalfEdge ad = next_half_edge(g), db = previous_half_edge(g);
    const std::int32_t c = start_of(_support, ca), d = start_of(_support, db);
    const Vec2 c_uv = start_uv(_support, ca), d_uv = start_uv(_support, db);
    const HalfEdge outside_ad = _twins[ad], outside_bc = _twins[bc];
    // The slots of the first triangle become d->c, c->a, a->d, those of the second c->d, d->b, b->c.
    const std::int32_t a = start_of(_support, h), b = start_of(_support, g);
    const Vec2 a_uv = start_uv(_support, h), b_uv = start_uv(_support, g);
    const HalfEdge outside_ca = _twins[ca], outside_db = _twins[db];
    set(h, d, d_uv), set(bc, c, c_uv), set(ca, a, a_uv);
    set(g, c, c_uv), set(ad, d, d_uv), set(db, b, b_uv);
    link(bc, outside_ca), link(ca, outside_ad), link(ad, outside_db), link(db, outside_bc);
  }

  void set(HalfEdge h, std::int32_t point, Vec2 uv) {
    _support.triangles[h / 3][h % 3] = point;
    _support.corner_uv[h / 3][h % 3] = uv;
  }

  void link(HalfEdge h, HalfEdge twin) {
    _twins[h] = twin;
    if (twin >= 0) _twins[twin] = h;
  }

  Support& _support;
  std::vector<HalfEdge> _twins;
};

}  // namespace

void flip_to_delaunay(Support& support) {
  Flipper(support).run();
}

}  // namespace aeroloom::surface
