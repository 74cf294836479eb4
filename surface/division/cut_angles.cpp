#include "surface/division/cut_angles.hpp"

#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;
using mesh::SharedVertexKey;

/// The corner of a piece at one of its border points.
struct Corner {
  std::int32_t before = -1, after = -1;  // points at the other ends of the fine edges there
};

std::vector<Corner> corners_of(const ChartSurface& surface) {
  std::vector<Corner> corners(surface.points.size());
  for (const auto& [from, to] : surface.loop_edges) {
    corners[from].after = to;
    corners[to].before = from;
  }
  return corners;
}

std::vector<Vec3> normals_of(const ChartSurface& surface) {
  std::vector<Vec3> normals(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t p : surface.triangles[t])
      normals[p] += area_vector(surface, static_cast<std::int32_t>(t));
  }
  return normals;
}

/// From the edge that leaves counter-clockwise to the one that arrives, in [0, 360).
double interior_angle(Vec3 normal, Vec3 leaving, Vec3 back) {
  const double angle = std::atan2(dot(normalized(normal), cross(leaving, back)), dot(leaving, back));
  return (angle < 0 ? angle + 2 * std::numbers::pi : angle) * 180 / std::numbers::pi;
}

}  // namespace

FeatureEdges::FeatureEdges(const ChartSurface& surface, const FaceVertices& vertices) {
  for (const auto& [a, b] : surface.loop_edges) {
    const SharedVertexKey first = vertices.vertex_keys[surface.mesh_vertex[a]];
    const SharedVertexKey second = vertices.vertex_keys[surface.mesh_vertex[b]];
    _edges.insert({std::min(first, second), std::max(first, second)});
  }
}

bool FeatureEdges::contains(SharedVertexKey a, SharedVertexKey b) const {
  return _edges.contains({std::min(a, b), std::max(a, b)});
}

std::vector<CutAngle> measure_cut_angles(const std::vector<PieceProblem>& problems,
                                         const FeatureEdges& features) {
  struct VertexAngle {
    SharedVertexKey vertex;
    CutAngle angle;
  };
  std::vector<VertexAngle> found;
  std::map<SharedVertexKey, int> corners_at;
  for (const PieceProblem& problem : problems) {
    const ChartSurface& surface = problem.surface;
    const std::vector<Corner> corners = corners_of(surface);
    const std::vector<Vec3> normals = normals_of(surface);
    const auto vertex_key = [&](std::int32_t p) {
      return problem.vertices.vertex_keys[surface.mesh_vertex[p]];
    };
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(corners.size()); ++p) {
      const auto [before, after] = corners[p];
      if (before < 0 || after < 0) continue;
      const SharedVertexKey here = vertex_key(p);
      ++corners_at[here];
      const bool forced =
          features.contains(here, vertex_key(before)) && features.contains(here, vertex_key(after));
      if (forced) continue;
      const Vec3 at = surface.points[p];
      found.push_back(
          {here,
           {surface.face, at,
            interior_angle(normals[p], surface.points[after] - at, surface.points[before] - at)}});
    }
  }
  std::vector<CutAngle> angles;
  for (const VertexAngle& one : found) {
    if (!mesh::is_cut_vertex_key(one.vertex) || corners_at[one.vertex] > 2) angles.push_back(one.angle);
  }
  return angles;
}

}  // namespace aeroloom::surface
