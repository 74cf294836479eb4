#include "surface/cusps/needles.hpp"

#include "surface/cusps/cusp_topology.hpp"
#include "surface/remesh/triangle_angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <tuple>

namespace aeroloom::surface {
namespace {

using cad::EdgeId;
using geometry::Vec3;
using mesh::LocalIndex;

/// A curve is as close as a needle is thin when the needle's height over the other curve is at most this
/// fraction of its side there. Chosen, not measured.
constexpr double close_fraction = 0.2;
/// Two curves run along each other where their segments enclose less than 30 degrees. Chosen, not measured.
const double along_cosine = std::cos(30 * std::numbers::pi / 180);
/// Vertices of one curve that are further apart along it than this belong to different stretches of it.
/// Chosen, not measured.
constexpr int same_stretch = 3;

class NeedleSearch {
public:
  NeedleSearch(const cad::Model& model, const CurveMesh& curves)
      : _model(model), _curves(curves), _first_edge(model.vertex_count() + 1, 0) {
    const auto each_end = [&](auto&& act) {
      for (EdgeId e = 0; e < model.edge_count(); ++e) {
        if (!is_constraining(model, e)) continue;
        act(model.edge(e).first, e);
        if (model.edge(e).last != model.edge(e).first) act(model.edge(e).last, e);
      }
    };
    each_end([&](cad::VertexId v, EdgeId) { ++_first_edge[v + 1]; });
    for (std::size_t v = 1; v < _first_edge.size(); ++v) _first_edge[v] += _first_edge[v - 1];
    _edges.resize(_first_edge.back());
    std::vector<std::int32_t> next = _first_edge;
    each_end([&](cad::VertexId v, EdgeId e) { _edges[next[v]++] = e; });
  }

  /// `on_curve`: as curve_vertices() has it, -1 also for apexes inside of a face (apexes.hpp).
  NeedleCause judge(const mesh::Piece& piece, const std::vector<CurveVertex>& on_curve,
                    const LocalIndex* triangle) const {
    std::array<Vec3, 3> p;
    std::array<CurveVertex, 3> v;
    for (int i = 0; i < 3; ++i) p[i] = piece.point(triangle[i]), v[i] = on_curve[triangle[i]];
    if (v[0] < 0 || v[1] < 0 || v[2] < 0) return NeedleCause::mesh;
    int apex = 0;
    for (int i = 1; i < 3; ++i) {
      if (distance(p[(i + 1) % 3], p[(i + 2) % 3]) < distance(p[(apex + 1) % 3], p[(apex + 2) % 3])) apex = i;
    }
    if (v[apex] < _model.vertex_count() && is_segment(v[apex], v[(apex + 1) % 3]) &&
        is_segment(v[apex], v[(apex + 2) % 3])) {
      return NeedleCause::corner;
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const Vec3 side = p[j] - p[i];
      const double height = norm(cross(side, p[k] - p[i])) / norm(side);
      if (height <= close_fraction * norm(side) && faces_other_curve(v[i], v[j], v[k], piece.common_face()))
        return NeedleCause::strip;
    }
    return NeedleCause::mesh;
  }

private:
  std::span<const EdgeId> edges_at(CurveVertex v, EdgeId& own) const {
    if (v < _model.vertex_count())
      return {_edges.data() + _first_edge[v], _edges.data() + _first_edge[v + 1]};
    own = _curves.edge_of(_model, v);
    return {&own, 1};
  }
  bool is_on(CurveVertex v, EdgeId edge) const {
    if (v >= _model.vertex_count()) return _curves.edge_of(_model, v) == edge;
    return _model.edge(edge).first == v || _model.edge(edge).last == v;
  }
  /// How many segments apart two vertices of an edge are along it.
  int steps_between(CurveVertex a, CurveVertex b, EdgeId edge) const {
    const cad::Edge& e = _model.edge(edge);
    const int first = _curves.first_interior[edge], last = _curves.first_interior[edge + 1];
    const auto places = [&](CurveVertex v) -> std::array<int, 2> {
      if (v >= _model.vertex_count()) return {v - first + 1, v - first + 1};
      return {v == e.first ? 0 : last - first + 1, v == e.last ? last - first + 1 : 0};
    };
    int steps = last - first + 1;
    for (const int x : places(a)) {
      for (const int y : places(b)) steps = std::min(steps, std::abs(x - y));
    }
    return steps;
  }
  /// Whether the vertices are neighbours on a curve.
  bool is_segment(CurveVertex a, CurveVertex b) const {
    EdgeId own = cad::no_entity;
    const auto edges = edges_at(a, own);
    return std::any_of(edges.begin(), edges.end(),
                       [&](EdgeId e) { return is_on(b, e) && steps_between(a, b, e) == 1; });
  }
  /// Whether a segment of the edge at c has the direction: from the vertex of ab next to c to the other. A
  /// short segment across the end of a curve makes no strip of the curves that it joins.
  bool runs_along(EdgeId edge, CurveVertex c, Vec3 direction) const {
    const cad::Edge& e = _model.edge(edge);
    const CurveVertex begin = _curves.first_interior[edge], end = _curves.first_interior[edge + 1];
    const bool inside = c >= _model.vertex_count();
    const auto is_along = [&](CurveVertex next) {
      const Vec3 segment = _curves.points[next] - _curves.points[c];
      return dot(segment, direction) >= along_cosine * norm(segment) * norm(direction);
    };
    if (inside) return is_along(c == begin ? e.first : c - 1) || is_along(c + 1 == end ? e.last : c + 1);
    return (c == e.first && is_along(begin < end ? begin : e.last)) ||
           (c == e.last && is_along(begin < end ? end - 1 : e.first));
  }
  /// Whether the side ab lies on a curve and c on another one of the face that has neither and runs along it,
  /// or far off on the same one.
  bool faces_other_curve(CurveVertex a, CurveVertex b, CurveVertex c, cad::FaceId face) const {
    if (!is_segment(a, b)) return false;
    EdgeId own = cad::no_entity;
    const Vec3 p = _curves.points[a], q = _curves.points[b], r = _curves.points[c];
    const Vec3 direction = distance(p, r) < distance(q, r) ? q - p : p - q;
    const auto is_apart = [&](EdgeId e) {
      const auto& users = _model.edge(e).faces;
      if (!std::binary_search(users.begin(), users.end(), face)) return false;
      for (const CurveVertex v : {a, b}) {
        if (is_on(v, e) && steps_between(v, c, e) < same_stretch) return false;
      }
      return runs_along(e, c, direction);
    };
    const auto edges = edges_at(c, own);
    return std::any_of(edges.begin(), edges.end(), is_apart);
  }

  const cad::Model& _model;
  const CurveMesh& _curves;
  std::vector<std::int32_t> _first_edge;  // per CAD vertex: into _edges
  std::vector<EdgeId> _edges;             // that constrain the mesh, by CAD vertex
};

}  // namespace

const char* name_of(NeedleCause cause) {
  return cause == NeedleCause::corner ? "corner" : cause == NeedleCause::strip ? "strip" : "mesh";
}

std::vector<Needle> find_needles(const cad::Model& model, const CurveMesh& curves,
                                 const mesh::DistributedMesh& surface) {
  const NeedleSearch search(model, curves);
  const double limit = std::pow(std::sin(needle_degrees * std::numbers::pi / 180), 2);
  std::vector<Needle> needles;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const mesh::Piece& piece = surface.pieces[i];
    const std::vector<CurveVertex> on_curve = curve_vertices(curves, piece);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      const std::array<Vec3, 3> p{piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
      const double sine = smallest_squared_sine(p[0], p[1], p[2]);
      if (sine >= limit) continue;
      needles.push_back(
          {i, t, search.judge(piece, on_curve, v), std::asin(std::sqrt(sine)) * 180 / std::numbers::pi});
    }
  }
  return needles;
}

std::vector<NeedleGroup> group_needles(const mesh::DistributedMesh& surface,
                                       const std::vector<Needle>& needles) {
  const auto order = [](const NeedleGroup& a, const NeedleGroup& b) {
    return std::tie(a.face, a.cause, a.degrees, a.at.x, a.at.y, a.at.z) <
           std::tie(b.face, b.cause, b.degrees, b.at.x, b.at.y, b.at.z);
  };
  // The first of each face and cause has the smallest angle, here and over all ranks.
  const auto merge = [&order](std::vector<NeedleGroup> rows) {
    std::sort(rows.begin(), rows.end(), order);
    std::vector<NeedleGroup> groups;
    for (const NeedleGroup& row : rows) {
      if (groups.empty() || groups.back().face != row.face || groups.back().cause != row.cause) {
        groups.push_back(row);
        continue;
      }
      groups.back().needles += row.needles;
      groups.back().below_half += row.below_half;
    }
    return groups;
  };
  std::vector<NeedleGroup> mine;
  for (const Needle& needle : needles) {
    const mesh::Piece& piece = surface.pieces[needle.piece];
    const LocalIndex* v = piece.cell(needle.triangle);
    const Vec3 middle = (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2])) / 3.0;
    mine.push_back({piece.common_face(), needle.cause, 1, needle.degrees < 0.5 * needle_degrees,
                    needle.degrees, middle});
  }
  return merge(surface.communicator.all_gather_items<NeedleGroup>(merge(std::move(mine))));
}

}  // namespace aeroloom::surface
