#include "surface/division/boundary_thinning.hpp"

#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/parameters.hpp"
#include "surface/charts/surface_topology.hpp"

#include <algorithm>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

class BoundaryThinner {
public:
  BoundaryThinner(const cad::Model& model, ChartSurface& surface)
      : _model(model), _surface(surface), _around(surface.points.size()) {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(surface.triangles.size()); ++t) {
      for (const std::int32_t p : surface.triangles[t]) _around[p].push_back(t);
    }
    _alive.assign(surface.triangles.size(), 1);
  }

  /// Contracts the point into its neighbour on the boundary, if no triangle folds.
  bool contract(std::int32_t gone, std::int32_t kept) {
    const Vec3 target = _surface.points[kept];
    geometry::Vec2 uv;
    bool joined = false;
    for (const std::int32_t t : _around[gone]) {
      const int k = corner(t, kept);
      if (k < 0) continue;
      joined = true;
      uv = _surface.corner_uv[t][k];
    }
    if (!joined) return false;
    for (const std::int32_t t : _around[gone]) {
      if (corner(t, kept) >= 0) continue;
      const Vec3 before = area_vector(_surface, t);
      auto points = _surface.triangles[t];
      Vec3 p[3];
      for (int i = 0; i < 3; ++i) p[i] = points[i] == gone ? target : _surface.points[points[i]];
      const Vec3 after = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
      // A triangle may tilt by 45 degrees, not more, or parameters fold; and must keep some area, or no
      // normal is left.
      constexpr double least_cosine = 0.7, least_area = 1e-3;
      if (dot(before, after) < least_cosine * norm(before) * norm(after) ||
          norm(after) < least_area * norm(before))
        return false;
    }
    for (const std::int32_t t : _around[gone]) {
      if (corner(t, kept) >= 0) {
        _alive[t] = 0;
        continue;
      }
      const int k = corner(t, gone);
      geometry::Vec2& at = _surface.corner_uv[t][k];
      at = unwrap(_model, _surface.face, uv, at);
      _surface.triangles[t][k] = kept;
      _around[kept].push_back(t);
    }
    for (const std::int32_t t : _around[gone]) {
      if (_alive[t]) continue;
      for (const std::int32_t p : _surface.triangles[t]) {
        if (p != gone) std::erase(_around[p], t);
      }
    }
    _around[gone].clear();
    return true;
  }

  /// Drops dead triangles and unused points.
  void compact() {
    std::vector<std::int32_t> number(_surface.points.size(), -1);
    ChartSurface compacted;
    compacted.face = _surface.face;
    for (std::size_t t = 0; t < _surface.triangles.size(); ++t) {
      if (!_alive[t]) continue;
      auto triangle = _surface.triangles[t];
      for (std::int32_t& p : triangle) {
        if (number[p] < 0) {
          number[p] = static_cast<std::int32_t>(compacted.points.size());
          compacted.points.push_back(_surface.points[p]);
          compacted.mesh_vertex.push_back(_surface.mesh_vertex[p]);
        }
        p = number[p];
      }
      compacted.triangles.push_back(triangle);
      compacted.corner_uv.push_back(_surface.corner_uv[t]);
    }
    _surface = std::move(compacted);
  }

private:
  int corner(std::int32_t t, std::int32_t point) const {
    const auto& p = _surface.triangles[t];
    return p[0] == point ? 0 : p[1] == point ? 1 : p[2] == point ? 2 : -1;
  }

  const cad::Model& _model;
  ChartSurface& _surface;
  std::vector<std::vector<std::int32_t>> _around;  // triangles per point
  std::vector<char> _alive;                        // per triangle
};

}  // namespace

void drop_boundary_vertices(const cad::Model& model, const std::vector<char>& keep, ChartSurface& surface) {
  const auto loops = trace_boundary(surface, geometry::match_half_edges(surface.triangles));
  std::vector<std::vector<std::int32_t>> points;
  for (const auto& loop : loops) {
    auto& line = points.emplace_back();
    for (const geometry::HalfEdge h : loop) line.push_back(start_of(surface, h));
  }
  BoundaryThinner thinner(model, surface);
  for (auto& line : points) {
    const auto is_kept = [&](std::int32_t p) {
      return surface.mesh_vertex[p] >= 0 && keep[surface.mesh_vertex[p]] != 0;
    };
    const auto first = std::find_if(line.begin(), line.end(), is_kept);
    if (first == line.end()) continue;
    std::rotate(line.begin(), first, line.end());
    std::int32_t last = line.front();
    for (std::size_t i = 1; i < line.size(); ++i) {
      const std::int32_t p = line[i];
      if (is_kept(p) || surface.mesh_vertex[p] < 0 || !thinner.contract(p, last)) last = p;
    }
  }
  for (std::int32_t& v : surface.mesh_vertex) v = v >= 0 && keep[v] != 0 ? v : -1;
  thinner.compact();
  flip_to_delaunay(surface);
  surface.loop_edges = trace_loop_edges(surface);
}

}  // namespace aeroloom::surface
