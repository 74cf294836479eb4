#include "cad/faceted/facet_walls.hpp"

#include "cad/faceted/facet_links.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Triangles that hang together over common points.
struct WallShell {
  std::vector<std::int32_t> triangles;
  Box box;
};

std::vector<WallShell> wall_shells(const FacetComplex& complex, const std::vector<char>& kept) {
  geometry::DisjointSets<std::int32_t> sets(complex.points.size());
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (!kept[t]) continue;
    sets.unite(complex.triangles[t][0], complex.triangles[t][1]);
    sets.unite(complex.triangles[t][0], complex.triangles[t][2]);
  }
  std::vector<std::int32_t> number(complex.points.size(), -1);
  std::vector<WallShell> shells;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (!kept[t]) continue;
    std::int32_t& shell = number[sets.root(complex.triangles[t][0])];
    if (shell < 0) shell = static_cast<std::int32_t>(shells.size()), shells.emplace_back();
    shells[shell].triangles.push_back(static_cast<std::int32_t>(t));
    for (const Vec3 p : corners_of(complex, static_cast<std::int32_t>(t))) shells[shell].box.add(p);
  }
  return shells;
}

/// Whether a closed surface encloses a point off it, by the solid angle it takes there (van Oosterom and
/// Strackee, IEEE Trans. Biomed. Eng. 30, 1983, doi:10.1109/TBME.1983.325207).
bool encloses(const FacetComplex& complex, const WallShell& shell, Vec3 point) {
  double angle = 0;
  for (const std::int32_t t : shell.triangles) {
    const auto corners = corners_of(complex, t);
    const Vec3 a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    angle +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

/// Drops the shells that lie inside others.
int drop_buried(const FacetComplex& complex, const std::vector<WallShell>& shells, std::vector<char>& kept) {
  int buried = 0;
  for (const WallShell& inner : shells) {
    const Vec3 point = complex.points[complex.triangles[inner.triangles.front()][0]];
    const bool inside = std::ranges::any_of(shells, [&](const WallShell& outer) {
      return &outer != &inner && outer.box.contains(inner.box) && encloses(complex, outer, point);
    });
    if (!inside) continue;
    ++buried;
    for (const std::int32_t t : inner.triangles) kept[t] = 0;
  }
  return buried;
}

/// What is kept, turned round, with its points and faces numbered anew.
class WallCollector {
public:
  WallCollector(const FacetComplex& bodies, const std::vector<char>& kept)
      : _bodies(bodies), _kept(kept), _point(bodies.points.size(), -1) {}

  FacetComplex run() {
    std::vector<FaceId> face(_bodies.faces.size(), no_entity);
    for (std::size_t t = 0; t < _kept.size(); ++t) {
      if (_kept[t]) face[_bodies.face_of[t]] = 0;
      for (int i = 0; i < 3 && _kept[t]; ++i) _point[_bodies.triangles[t][i]] = 0;
    }
    for (std::size_t f = 0; f < face.size(); ++f) {
      if (face[f] == no_entity) continue;
      face[f] = static_cast<FaceId>(_walls.faces.size());
      FacetComplex::Face& wall = _walls.faces.emplace_back(_bodies.faces[f]);
      if (wall.part.empty() && wall.front != no_entity) wall.part = _bodies.regions[wall.front];
      wall.front = 0, wall.back = no_entity;
    }
    for (std::size_t p = 0; p < _point.size(); ++p) {
      if (_point[p] < 0) continue;
      _point[p] = static_cast<std::int32_t>(_walls.points.size());
      _walls.points.push_back(_bodies.points[p]);
    }
    for (std::size_t t = 0; t < _kept.size(); ++t) {
      if (!_kept[t]) continue;
      const auto& [a, b, c] = _bodies.triangles[t];
      _walls.triangles.push_back({_point[a], _point[c], _point[b]});
      _walls.face_of.push_back(face[_bodies.face_of[t]]);
    }
    take_curves();
    return std::move(_walls);
  }

private:
  void take_curves() {
    const FacetLinks links = link_facets(_bodies);
    std::vector<char> used(_bodies.curves.size(), 0), at_end(_walls.points.size(), 0);
    for (std::size_t h = 0; h < links.on_curve.size(); ++h) {
      if (links.on_curve[h].curve != no_entity && _kept[h / 3]) used[links.on_curve[h].curve] = 1;
    }
    for (std::size_t c = 0; c < used.size(); ++c) {
      if (!used[c]) continue;
      FacetComplex::Curve curve = _bodies.curves[c];
      for (std::int32_t& p : curve.points) p = _point[p];
      at_end[curve.points.front()] = at_end[curve.points.back()] = 1;
      _walls.curves.push_back(std::move(curve));
    }
    for (std::size_t p = 0; p < at_end.size(); ++p) {
      if (at_end[p]) _walls.vertices.push_back(static_cast<std::int32_t>(p));
    }
  }

  const FacetComplex& _bodies;
  const std::vector<char>& _kept;
  std::vector<std::int32_t> _point;  // per point of the bodies, that of the walls
  FacetComplex _walls;
};

}  // namespace

FacetComplex outer_walls(const FacetComplex& bodies, Changes& changes) {
  std::vector<char> kept(bodies.triangles.size());
  int inner = 0, cavities = 0;
  for (const FacetComplex::Face& face : bodies.faces) {
    inner += face.back != no_entity;
    cavities += face.back == no_entity && face.cavity;
  }
  for (std::size_t t = 0; t < kept.size(); ++t) {
    const FacetComplex::Face& face = bodies.faces[bodies.face_of[t]];
    kept[t] = face.back == no_entity && !face.cavity;
  }
  const int buried = drop_buried(bodies, wall_shells(bodies, kept), kept);
  if (inner > 0)
    changes.push_back({fmt::format("{} faces between bodies do not reach the fluid: left out", inner)});
  if (cavities > 0) {
    changes.push_back(
        {fmt::format("{} faces of cavities inside a body do not reach the fluid: left out", cavities)});
  }
  if (buried > 0) {
    changes.push_back(
        {fmt::format("{} bodies lie inside others and do not reach the fluid: left out", buried)});
  }
  return WallCollector(bodies, kept).run();
}

double enclosed_volume(const FacetComplex& complex) {
  const Vec3 middle = box_of_points(complex.points).center();
  double volume = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(complex.triangles.size()); ++t) {
    const auto corners = corners_of(complex, t);
    volume += dot(corners[0] - middle, cross(corners[1] - middle, corners[2] - middle)) / 6;
  }
  return volume;
}

}  // namespace aeroloom::cad
