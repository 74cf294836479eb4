#include "surface/cusps/cusps.hpp"

#include "parallel/observation/timers.hpp"
#include "sizing/features/segment_tree.hpp"
#include "surface/curves/cusp_alignment.hpp"
#include "surface/cusps/cusp_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// The points of a half edge from the CAD vertex on.
struct CuspSide {
  std::vector<CurveVertex> vertices;
  std::vector<Vec3> points;

  CuspSide(const Model& model, const CurveMesh& curves, cad::EdgeEnd end)
      : vertices(near_half(model, curves, end)) {
    for (const CurveVertex v : vertices) points.push_back(curves.points[v]);
  }
  /// Of the two segments that end at vertex i.
  double shorter_segment(std::size_t i) const {
    return std::min(distance(points[i - 1], points[i]), distance(points[i], points[i + 1]));
  }
  /// How far a point is from them.
  double distance_from(Vec3 p, std::size_t i) const {
    return std::min(sizing::distance_to_segment(p, points[i - 1], points[i]),
                    sizing::distance_to_segment(p, points[i], points[i + 1]));
  }
};

Cusp measure_cusp(const Model& model, const CurveMesh& curves, double widest, const SharpCorner& corner) {
  Cusp cusp{corner.face, corner.vertex, {}};
  const CuspSide a(model, curves, corner.ends[0]), b(model, curves, corner.ends[1]);
  for (std::size_t i = 1; i + 1 < std::min(a.points.size(), b.points.size()); ++i) {
    const double segment = std::min(a.shorter_segment(i), b.shorter_segment(i));
    const double gap = std::max(a.distance_from(b.points[i], i), b.distance_from(a.points[i], i));
    if (!(gap < std::min(widest, closing_width * segment)) ||
        !(distance(a.points[i], b.points[i]) < closing_width * segment))
      break;
    cusp.pairs.push_back({a.vertices[i], b.vertices[i]});
  }
  return cusp;
}

/// The axis that an exact plane is normal to.
int axis_of_plane(const Model& model, cad::FaceId face) {
  const cad::Coedge& use = model.face(face).loops.front().front();
  const geometry::Vec2 uv = model.edge_uv(face, use, model.edge(use.edge).first_parameter);
  const Vec3 normal = model.face_frame(face, uv).normal;
  int axis = 0;
  for (const int other : {1, 2}) {
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  }
  return axis;
}

/// Vertices that become one: the lowest stands for all, at their mean, but on every exact plane (a plane of
/// symmetry, say) that one of them lies on.
class ClosedVertices {
public:
  ClosedVertices(const Model& model, const CurveMesh& curves, const std::vector<Cusp>& cusps)
      : _model(model), _curves(curves) {
    std::map<CurveVertex, CurveVertex> parent;
    auto root = [&parent](CurveVertex v) {
      for (auto at = parent.find(v); at != parent.end() && at->second != v; at = parent.find(v))
        v = at->second;
      return v;
    };
    for (const Cusp& cusp : cusps) {
      for (const auto& pair : cusp.pairs) {
        const CurveVertex a = root(pair[0]), b = root(pair[1]);
        parent[std::max(a, b)] = std::min(a, b);
        parent.try_emplace(std::min(a, b), std::min(a, b));
        for (const CurveVertex v : {std::min(a, b), pair[0], pair[1]}) _cusp_of[v] = cusp.vertex;
      }
    }
    std::map<CurveVertex, std::pair<Vec3, int>> sums;
    for (const auto& [v, unused] : parent) {
      _root[v] = root(v);
      auto& [sum, count] = sums[_root[v]];
      sum += curves.points[v];
      ++count;
    }
    for (const auto& [v, sum] : sums) _point[v] = (1.0 / sum.second) * sum.first;
    for (const auto& [v, root] : _root) keep_on_planes(v, _point[root]);
  }

  /// The vertex that stands for v; v itself where nothing closes.
  CurveVertex root(CurveVertex v) const {
    const auto found = _root.find(v);
    return found == _root.end() ? v : found->second;
  }
  bool contains(CurveVertex v) const { return _root.contains(v); }
  Vec3 point(CurveVertex v) const { return _point.at(root(v)); }
  cad::VertexId cusp_vertex_of(CurveVertex v) const { return _cusp_of.at(root(v)); }
  mesh::SharedVertexKey vertex_key(CurveVertex v) const { return _curves.vertex_key(_model, root(v)); }

private:
  /// Planes through one CAD vertex agree where they have an axis in common.
  void keep_on_planes(CurveVertex v, Vec3& point) const {
    for (const cad::FaceId face : _model.edge(_curves.edge_of(_model, v)).faces) {
      if (!_model.is_exact_plane(face)) continue;
      const int axis = axis_of_plane(_model, face);
      point[axis] = _curves.points[v][axis];
    }
  }

  const Model& _model;
  const CurveMesh& _curves;
  std::map<CurveVertex, CurveVertex> _root;
  std::map<CurveVertex, Vec3> _point;
  std::map<CurveVertex, cad::VertexId> _cusp_of;
};

/// The piece with vertices that closed, without the triangles that vanish.
Piece close_piece(const Piece& piece, const std::vector<CurveVertex>& on_curve, const ClosedVertices& closed,
                  const std::vector<const Cusp*>& cusps) {
  std::vector<char> vanishes(piece.cell_count(), 0);
  for (const Cusp* cusp : cusps) {
    const auto ranks = levels_in_cusp(*cusp, on_curve);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t)
      vanishes[t] |= level_of_triangle(piece.cell(t), ranks) >= 0;
  }
  std::vector<LocalIndex> stands_for(piece.vertex_count());
  std::iota(stands_for.begin(), stands_for.end(), 0);
  std::map<CurveVertex, LocalIndex> first;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (on_curve[v] >= 0 && closed.contains(on_curve[v]))
      stands_for[v] = first.try_emplace(closed.root(on_curve[v]), v).first->second;
  }
  Piece result;
  result.id = piece.id, result.kind = piece.kind, result.region = piece.region;
  std::vector<char> used(piece.vertex_count(), 0);
  std::vector<std::array<LocalIndex, 3>> kept;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    const std::array<LocalIndex, 3> now{stands_for[v[0]], stands_for[v[1]], stands_for[v[2]]};
    if (vanishes[t] || now[0] == now[1] || now[1] == now[2] || now[2] == now[0]) continue;
    kept.push_back(now);
    result.triangle_face.push_back(piece.triangle_face[t]);
    result.triangle_patch.push_back(piece.triangle_patch[t]);
    for (const LocalIndex w : now) used[w] = 1;
  }
  std::vector<LocalIndex> number(piece.vertex_count(), -1);
  std::size_t s = 0;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const bool shared = s < piece.shared_vertices.size() && piece.shared_vertices[s] == v;
    const mesh::SharedVertexKey vertex_key = shared ? piece.shared_keys[s++] : 0;
    if (!used[v]) continue;
    number[v] = result.vertex_count();
    const bool moves = on_curve[v] >= 0 && closed.contains(on_curve[v]);
    const Vec3 p = moves ? closed.point(on_curve[v]) : piece.point(v);
    result.coordinates.insert(result.coordinates.end(), {p.x, p.y, p.z});
    result.vertex_dimension.push_back(moves ? mesh::CadDimension::vertex : piece.vertex_dimension[v]);
    result.vertex_entity.push_back(moves ? closed.cusp_vertex_of(on_curve[v]) : piece.vertex_entity[v]);
    if (!shared) continue;
    result.shared_vertices.push_back(number[v]);
    result.shared_keys.push_back(moves ? closed.vertex_key(on_curve[v]) : vertex_key);
  }
  for (const auto& triangle : kept) {
    for (const LocalIndex v : triangle) result.cells.push_back(number[v]);
  }
  return result;
}

std::vector<ClosedCusp> describe(const CurveMesh& curves, const std::vector<Cusp>& cusps,
                                 const ClosedVertices& closed) {
  std::vector<ClosedCusp> result;
  for (const Cusp& cusp : cusps) {
    ClosedCusp row{cusp.face, curves.points[cusp.vertex], 0, 0};
    for (const auto& pair : cusp.pairs) {
      row.length = std::max(row.length, distance(closed.point(pair[0]), row.point));
      for (const CurveVertex v : pair)
        row.moved = std::max(row.moved, distance(closed.point(v), curves.points[v]));
    }
    result.push_back(row);
  }
  return result;
}

}  // namespace

std::vector<ClosedCusp> close_cusps(const Model& model, const CurveMesh& curves, double widest,
                                    mesh::DistributedMesh& surface) {
  std::vector<Cusp> cusps;
  for (const SharpCorner& corner : curves.sharp_corners) {
    if (!corner.closes) continue;
    Cusp cusp = measure_cusp(model, curves, widest, corner);
    if (!cusp.pairs.empty()) cusps.push_back(std::move(cusp));
  }
  if (cusps.empty()) return {};
  cusps = closable_cusps(curves, surface, std::move(cusps));
  if (cusps.empty()) return {};
  const ClosedVertices closed(model, curves, cusps);
  const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
  for (Piece& piece : surface.pieces) {
    const std::vector<CurveVertex> on_curve = curve_vertices(curves, piece);
    const bool touched = std::any_of(on_curve.begin(), on_curve.end(),
                                     [&](CurveVertex v) { return v >= 0 && closed.contains(v); });
    if (!touched) continue;
    std::vector<const Cusp*> own;
    for (const Cusp& cusp : cusps) {
      if (cusp.face == piece.common_face()) own.push_back(&cusp);
    }
    piece = close_piece(piece, on_curve, closed, own);
  }
  return describe(curves, cusps, closed);
}

}  // namespace aeroloom::surface
