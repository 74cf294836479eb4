#include "surface/charts/delaunay_flips.hpp"

#include "geometry/predicates.hpp"
#include "surface/charts/surface_topology.hpp"

#include <cmath>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Triangles that turn by more than this (10 degrees) are not merged into one plane for a flip. Chosen, not
/// measured.
constexpr double coplanar_cosine = 0.985;
/// Angles that sum to 180 degrees but for rounding do not ask for a flip.
constexpr double angle_tolerance = 1e-9;  // radians

/// Two triangles (a,b,c) and (b,a,d) on either side of the half-edges ab and ba.
struct Diamond {
  geometry::HalfEdge ab, ba;

  geometry::HalfEdge bc() const { return geometry::next_half_edge(ab); }
  geometry::HalfEdge ca() const { return geometry::previous_half_edge(ab); }
  geometry::HalfEdge ad() const { return geometry::next_half_edge(ba); }
  geometry::HalfEdge db() const { return geometry::previous_half_edge(ba); }
};

/// Whether the angles at c and d, opposite the edge ab, sum to more than 180 degrees.
bool is_not_delaunay(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 ca = a - c, cb = b - c, da = a - d, db = b - d;
  const double sine = norm(cross(ca, cb)) * dot(da, db) + norm(cross(da, db)) * dot(ca, cb);
  return sine < -angle_tolerance * norm(ca) * norm(cb) * norm(da) * norm(db);
}

/// Flips edges for as long as `wants(diamond)` holds for any.
template <class Wants>
class Flipper {
public:
  Flipper(ChartSurface& surface, Wants wants)
      : _surface(surface), _wants(wants), _twins(geometry::match_half_edges(surface.triangles)) {}

  void run() {
    const geometry::HalfEdge count = static_cast<geometry::HalfEdge>(_twins.size());
    std::vector<geometry::HalfEdge> queue;
    std::vector<char> queued(count, 0);
    for (geometry::HalfEdge h = count - 1; h >= 0; --h) {
      if (_twins[h] > h) queue.push_back(h), queued[h] = 1;
    }
    // Angles of neighbours change a little with every flip on a curved chart surface, so termination is
    // enforced: after many times as many looks as there are edges.
    constexpr std::int64_t looks_per_half_edge = 8;
    for (std::int64_t left = looks_per_half_edge * static_cast<std::int64_t>(count);
         !queue.empty() && left > 0; --left) {
      const geometry::HalfEdge h = queue.back();
      queue.pop_back();
      queued[h] = 0;
      if (_twins[h] < 0 || !may_flip({h, _twins[h]})) continue;
      const Diamond diamond{h, _twins[h]};
      flip(diamond);
      for (const geometry::HalfEdge around : {diamond.bc(), diamond.ca(), diamond.ad(), diamond.db()}) {
        if (!queued[around]) queue.push_back(around), queued[around] = 1;
      }
    }
  }

private:
  bool may_flip(const Diamond& diamond) const {
    const std::int32_t c = start_of(_surface, diamond.ca()), d = start_of(_surface, diamond.db());
    return c != d && _wants(diamond) && !are_joined(diamond.ca(), d);
  }

  /// Whether the point at the start of half-edge `from` has an edge to `to`.
  bool are_joined(geometry::HalfEdge from, std::int32_t to) const {
    const auto meets = [&](geometry::HalfEdge h) {
      return end_of(_surface, h) == to || end_of(_surface, geometry::next_half_edge(h)) == to;
    };
    geometry::HalfEdge h = from;
    do {
      if (meets(h)) return true;
      h = _twins[geometry::previous_half_edge(h)];
    } while (h >= 0 && h != from);
    if (h == from) return false;
    for (h = _twins[from]; h >= 0; h = _twins[h]) {
      h = geometry::next_half_edge(h);
      if (meets(h)) return true;
    }
    return false;
  }

  /// Triangles (a,b,c), (b,a,d) become (d,c,a) and (c,d,b): the half-edges ab, bc, ca become dc, ca, ad, and
  /// ba, ad, db become cd, db, bc.
  void flip(const Diamond& diamond) {
    const auto [ab, ba] = diamond;
    const geometry::HalfEdge bc = diamond.bc(), ca = diamond.ca(), ad = diamond.ad(), db = diamond.db();
    const std::int32_t a = start_of(_surface, ab), b = start_of(_surface, ba);
    const std::int32_t c = start_of(_surface, ca), d = start_of(_surface, db);
    const Vec2 a_uv = start_uv(_surface, ab), b_uv = start_uv(_surface, ba);
    const Vec2 c_uv = start_uv(_surface, ca), d_uv = start_uv(_surface, db);
    const geometry::HalfEdge twin_bc = _twins[bc], twin_ca = _twins[ca], twin_ad = _twins[ad],
                             twin_db = _twins[db];
    set(ab, d, d_uv), set(bc, c, c_uv), set(ca, a, a_uv);
    set(ba, c, c_uv), set(ad, d, d_uv), set(db, b, b_uv);
    link(bc, twin_ca), link(ca, twin_ad), link(ad, twin_db), link(db, twin_bc);
  }

  void set(geometry::HalfEdge h, std::int32_t point, Vec2 uv) {
    _surface.triangles[h / 3][h % 3] = point;
    _surface.corner_uv[h / 3][h % 3] = uv;
  }

  void link(geometry::HalfEdge h, geometry::HalfEdge twin) {
    _twins[h] = twin;
    if (twin >= 0) _twins[twin] = h;
  }

  ChartSurface& _surface;
  Wants _wants;
  std::vector<geometry::HalfEdge> _twins;
};

/// The rule of flip_to_delaunay().
class SpaceRule {
public:
  explicit SpaceRule(const ChartSurface& surface) : _surface(surface) {}

  bool operator()(const Diamond& diamond) const {
    const Vec3 a = point(diamond.ab), b = point(diamond.ba), c = point(diamond.ca()), d = point(diamond.db());
    return is_not_delaunay(a, b, c, d) && keeps_space(a, b, c, d) && keeps_plane(diamond);
  }

private:
  Vec3 point(geometry::HalfEdge h) const { return _surface.points[start_of(_surface, h)]; }

  static bool keeps_space(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
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

  bool keeps_plane(const Diamond& diamond) const {
    const Vec2 a = start_uv(_surface, diamond.ab), b = end_uv(_surface, diamond.ab);
    if (!(a == end_uv(_surface, diamond.ba) && b == start_uv(_surface, diamond.ba))) return false;
    const Vec2 c = start_uv(_surface, diamond.ca()), d = start_uv(_surface, diamond.db());
    return cross(d - a, c - a) * cross(b - d, c - d) > 0;
  }

  const ChartSurface& _surface;
};

/// The rule of flip_in_parameters().
class ParameterRule {
public:
  ParameterRule(const ChartSurface& surface, const std::vector<SurfaceMetric>& metrics,
                const std::vector<std::int32_t>& same, int orientation)
      : _surface(surface), _metrics(metrics), _same(same), _orientation(orientation) {}

  bool operator()(const Diamond& diamond) const {
    const std::int32_t ia = start_of(_surface, diamond.ab), ib = start_of(_surface, diamond.ba);
    const std::int32_t ic = start_of(_surface, diamond.ca()), id = start_of(_surface, diamond.db());
    if (_same[ic] == _same[id]) return false;
    const Vec2 a = start_uv(_surface, diamond.ab), b = start_uv(_surface, diamond.ba);
    const Vec2 c = start_uv(_surface, diamond.ca()), d = start_uv(_surface, diamond.db());
    if (geometry::orient2d(a, d, c) != _orientation || geometry::orient2d(d, b, c) != _orientation)
      return false;
    if (geometry::orient2d(a, b, c) != _orientation || geometry::orient2d(b, a, d) != _orientation)
      return true;
    const SurfaceMetric metric = mean({ia, ib, ic, id});
    const double determinant = metric.uu * metric.vv - metric.uv * metric.uv;
    constexpr double singular = 1e-12;  // at a pole, where parameters are no plane
    if (!(determinant > singular * metric.uu * metric.vv)) {
      return is_not_delaunay(_surface.points[ia], _surface.points[ib], _surface.points[ic],
                             _surface.points[id]);
    }
    // Lengths in this plane are lengths on the surface.
    const double root = std::sqrt(metric.uu), height = std::sqrt(determinant) / root;
    const auto flat = [&](Vec2 p) { return Vec3{root * p.x + metric.uv / root * p.y, height * p.y, 0}; };
    return is_not_delaunay(flat(a), flat(b), flat(c), flat(d));
  }

private:
  SurfaceMetric mean(const std::array<std::int32_t, 4>& corners) const {
    SurfaceMetric sum;
    for (const std::int32_t p : corners)
      sum.uu += 0.25 * _metrics[p].uu, sum.uv += 0.25 * _metrics[p].uv, sum.vv += 0.25 * _metrics[p].vv;
    return sum;
  }

  const ChartSurface& _surface;
  const std::vector<SurfaceMetric>& _metrics;
  const std::vector<std::int32_t>& _same;
  int _orientation;
};

}  // namespace

void flip_to_delaunay(ChartSurface& surface) {
  Flipper(surface, SpaceRule(surface)).run();
}

void flip_in_parameters(ChartSurface& surface, const std::vector<SurfaceMetric>& metrics,
                        const std::vector<std::int32_t>& same, int orientation) {
  Flipper(surface, ParameterRule(surface, metrics, same, orientation)).run();
}

}  // namespace aeroloom::surface
