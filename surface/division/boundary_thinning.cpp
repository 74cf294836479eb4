#include "surface/division/boundary_thinning.hpp"

#include "surface/charts/parameters.hpp"
#include "surface/charts/support_flips.hpp"
#include "surface/charts/support_topology.hpp"

#include <algorithm>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

class BoundaryThinner {
public:
  BoundaryThinner(const cad::Model& model, Support& support)
      : _model(model), _support(support), _around(support.points.size()) {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(support.triangles.size()); ++t) {
      for (const std::int32_t p : support.triangles[t]) _around[p].push_back(t);
    }
    _alive.assign(support.triangles.size(), 1);
  }

  /// Contracts the point into its neighbour on the boundary, if no triangle folds.
  bool contract(std::int32_t gone, std::int32_t kept) {
    const Vec3 target = _support.points[kept];
    geometry::Vec2 uv;
    bool joined = false;
    for (const std::int32_t t : _around[gone]) {
      const int k = corner(t, kept);
      if (k < 0) continue;
      joined = true;
      uv = _support.corner_uv[t][k];
    }
    if (!joined) return false;
    for (const std::int32_t t : _around[gone]) {
      if (corner(t, kept) >= 0) continue;
      const Vec3 before = area_vector(_support, t);
      auto points = _support.triangles[t];
      Vec3 p[3];
      for (int i = 0; i < 3; ++i) p[i] = points[i] == gone ? target : _support.points[points[i]];
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
      geometry::Vec2& at = _support.corner_uv[t][k];
      at = unwrap(_model, _support.face, uv, at);
      _support.triangles[t][k] = kept;
      _around[kept].push_back(t);
    }
    for (const std::int32_t t : _around[gone]) {
      if (_alive[t]) continue;
      for (const std::int32_t p : _support.triangles[t]) {
        if (p != gone) std::erase(_around[p], t);
      }
    }
    _around[gone].clear();
    return true;
  }

  /// Drops dead triangles and unused points.
  void compact() {
    std::vector<std::int32_t> number(_support.points.size(), -1);
    Support compacted;
    compacted.face = _support.face;
    for (std::size_t t = 0; t < _support.triangles.size(); ++t) {
      if (!_alive[t]) continue;
      auto triangle = _support.triangles[t];
      for (std::int32_t& p : triangle) {
        if (number[p] < 0) {
          number[p] = static_cast<std::int32_t>(compacted.points.size());
          compacted.points.push_back(_support.points[p]);
          compacted.mesh_vertex.push_back(_support.mesh_vertex[p]);
        }
        p = number[p];
      }
      compacted.triangles.push_back(triangle);
      compacted.corner_uv.push_back(_support.corner_uv[t]);
    }
    _support = std::move(compacted);
  }

private:
  int corner(std::int32_t t, std::int32_t point) const {
    const auto& p = _support.triangles[t];
    return p[0] == point ? 0 : p[1] == point ? 1 : p[2] == point ? 2 : -1;
  }

  const cad::Model& _model;
  Support& _support;
  std::vector<std::vector<std::int32_t>> _around;  // triangles per point
  std::vector<char> _alive;                        // per triangle
};

}  // namespace

void drop_boundary_vertices(const cad::Model& model, const std::vector<char>& keep, Support& support) {
  const auto loops = trace_boundary(support, geometry::match_half_edges(support.triangles));
  std::vector<std::vector<std::int32_t>> points;
  for (const auto& loop : loops) {
    auto& line = points.emplace_back();
    for (const geometry::HalfEdge h : loop) line.push_back(start_of(support, h));
  }
  BoundaryThinner thinner(model, support);
  for (auto& line : points) {
    const auto is_kept = [&](std::int32_t p) {
      return support.mesh_vertex[p] >= 0 && keep[support.mesh_vertex[p]] != 0;
    };
    const auto first = std::find_if(line.begin(), line.end(), is_kept);
    if (first == line.end()) continue;
    std::rotate(line.begin(), first, line.end());
    std::int32_t last = line.front();
    for (std::size_t i = 1; i < line.size(); ++i) {
      const std::int32_t p = line[i];
      if (is_kept(p) || support.mesh_vertex[p] < 0 || !thinner.contract(p, last)) last = p;
    }
  }
  for (std::int32_t& v : support.mesh_vertex) v = v >= 0 && keep[v] != 0 ? v : -1;
  thinner.compact();
  flip_to_delaunay(support);
  support.loop_edges = trace_loop_edges(support);
}

}  // namespace aeroloom::surface
