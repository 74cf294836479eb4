#include "improve/operations/edge_contraction.hpp"

#include "mesh/data/cad_dimension.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::improve {
namespace {

bool has(const TriangleCorners& corners, LocalIndex v) {
  return corners[0] == v || corners[1] == v || corners[2] == v;
}

}  // namespace

bool EdgeContraction::may_vanish(const TetMesh& mesh, LocalIndex from, LocalIndex to) {
  if (mesh.is_shared(from) || is_on_curve(mesh.dimension(from))) return false;
  _triangles.clear();
  for (const LocalIndex t : _star) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = mesh.twin(4 * t + f);
      if (other >= 0 || mesh.corners(t)[f] == from) continue;
      if (!is_triangle(other) || !mesh.is_free_triangle(triangle_of(other))) return false;
      _triangles.push_back(triangle_of(other));
    }
  }
  if (_triangles.empty()) return mesh.dimension(from) == mesh::CadDimension::region;
  // One fan of triangles of one face, two of which have the edge.
  std::size_t at_edge = 0;
  for (const LocalIndex i : _triangles) {
    if (!mesh.on_same_face(i, _triangles[0])) return false;
    at_edge += has(mesh.triangle(i), to);
  }
  return at_edge == 2;
}

bool EdgeContraction::keeps_lengths(const TetMesh& mesh, LocalIndex from, LocalIndex to) const {
  const Vec3 here = mesh.point(from), there = mesh.point(to);
  double old_longest = 0, new_longest = 0;
  for (const LocalIndex t : _star) {
    for (const LocalIndex v : mesh.corners(t)) {
      old_longest = std::max(old_longest, distance(mesh.point(v), here));
      new_longest = std::max(new_longest, distance(mesh.point(v), there));
    }
  }
  return new_longest <= most_growth * old_longest;
}

bool EdgeContraction::keeps_boundary(TetMesh& mesh, LocalIndex from, LocalIndex to) {
  if (_triangles.empty()) return true;
  _before.clear();
  _after.clear();
  for (const LocalIndex i : _triangles) {
    TriangleCorners corners = mesh.triangle(i);
    _before.push_back(points_of(mesh, corners));
    if (has(corners, to)) continue;
    std::replace(corners.begin(), corners.end(), from, to);
    _after.push_back(points_of(mesh, corners));
  }
  if (!is_gentle_change(_before, _after)) return false;
  // New edges must be new: the neighbours of both ends on the boundary are those at the edge's triangles.
  for (const LocalIndex i : _triangles) {
    for (const LocalIndex v : mesh.triangle(i)) {
      if (v == from || v == to) continue;
      const bool at_edge = std::any_of(_triangles.begin(), _triangles.end(), [&](LocalIndex k) {
        return has(mesh.triangle(k), v) && has(mesh.triangle(k), to);
      });
      if (!at_edge && _edges.exists(mesh, to, v)) return false;
    }
  }
  return true;
}

bool EdgeContraction::propose(TetMesh& mesh, LocalIndex from, LocalIndex to, double floor,
                              CavityReplacement& cavity) {
  if (mesh.is_shared(from) || is_on_curve(mesh.dimension(from))) return false;
  mesh.collect_star(from, _star);
  cavity.clear();
  cavity.before = mesh.worst_of(_star);
  floor = std::max(floor, cavity.before);
  cavity.after = 1;
  for (const LocalIndex t : _star) {
    Corners corners = mesh.corners(t);
    if (corners[mesh.local_vertex(t, to)] == to) continue;
    corners[mesh.local_vertex(t, from)] = to;
    cavity.after = std::min(cavity.after, mesh.quality_of(corners));
    if (cavity.after <= floor) return false;
    cavity.new_tets.push_back(corners);
  }
  if (cavity.new_tets.empty() || !may_vanish(mesh, from, to) || !keeps_lengths(mesh, from, to) ||
      !keeps_boundary(mesh, from, to)) {
    return false;
  }
  cavity.old_tets = _star;
  cavity.old_triangles = _triangles;
  return true;
}

bool EdgeContraction::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  _best.clear();
  const double least = mesh.quality(t);
  for (const auto& [i, k] : mesh::tetrahedron_edges) {
    const LocalIndex a = mesh.corners(t)[i], b = mesh.corners(t)[k];
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      if (propose(mesh, from, to, std::max(least, _best.after), _change)) std::swap(_best, _change);
    }
  }
  return _best.improves() && context.apply(_best);
}

}  // namespace aeroloom::improve
