#include "surface/background.hpp"

#include "surface/support_mesher.hpp"
#include "surface/support_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace aeroloom::surface {
namespace {

using geometry::Model;
using geometry::Vec2;
using geometry::Vec3;

constexpr double degree = std::numbers::pi / 180;
/// Of curves and of the surface along an edge of the background.
constexpr double largest_turn = 30 * degree;
constexpr int smoothing_sweeps = 3;
/// Facets of the support turn less than this: edges between points whose normals differ by more are divided,
/// in so many rounds.
constexpr double facet_turn = 12 * degree;
constexpr int dividing_rounds = 3;

/// The parameter nearest to `reference` of those that stand for the same place.
double unwrap(double parameter, double reference, double period) {
  return period > 0 ? parameter - period * std::round((parameter - reference) / period) : parameter;
}

/// Parameters at the corners of each triangle, without jumps inside it: those of vertices beyond a seam are
/// moved by a period, and the direction that means nothing at a pole is taken from the other corners.
class CornerParameters {
public:
  CornerParameters(const Model& model, const FaceMesh& mesh)
      : _mesh(mesh), _periods(model.parameter_periods(mesh.face)), _collapsed(mesh.points.size()) {
    if (model.is_planar(mesh.face)) return;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const geometry::SurfaceFrame frame = model.face_frame(mesh.face, mesh.uv[v]);
      const double u = norm(frame.du), v_length = norm(frame.dv);
      constexpr double vanishing = 1e-6;  // one derivative next to the other
      _collapsed[v] = {u <= vanishing * v_length, v_length <= vanishing * u};
    }
  }

  std::array<Vec2, 3> operator()(const std::array<std::int32_t, 3>& triangle) const {
    std::array<Vec2, 3> uv;
    std::array<std::array<double, 3>, 2> values;
    for (int direction = 0; direction < 2; ++direction) {
      const double period = direction == 0 ? _periods.x : _periods.y;
      int reference = -1;
      double sum = 0;
      int count = 0;
      for (int i = 0; i < 3; ++i) {
        const Vec2 at = _mesh.uv[triangle[i]];
        values[direction][i] = direction == 0 ? at.x : at.y;
        if (_collapsed[triangle[i]][direction]) continue;
        if (reference < 0) reference = i;
        values[direction][i] = unwrap(values[direction][i], values[direction][reference], period);
        sum += values[direction][i];
        ++count;
      }
      for (int i = 0; i < 3 && count > 0; ++i) {
        if (_collapsed[triangle[i]][direction]) values[direction][i] = sum / count;
      }
    }
    for (int i = 0; i < 3; ++i) uv[i] = {values[0][i], values[1][i]};
    return uv;
  }

private:
  const FaceMesh& _mesh;
  Vec2 _periods;
  std::vector<std::array<bool, 2>> _collapsed;  // per vertex: u means nothing there, v means nothing there
};

void carry_over(const std::vector<std::int32_t>& former, std::vector<std::int32_t>& part) {
  std::vector<std::int32_t> now;
  now.reserve(former.size());
  for (const std::int32_t t : former) now.push_back(part[t]);
  part = std::move(now);
}

/// Builds the support step by step.
class SupportBuilder {
public:
  SupportBuilder(const Model& model, const FaceBackground& background, const CurveMesh& curves,
                 std::vector<std::int32_t>& part)
      : _model(model), _background(background), _curves(curves), _part(part) {
    const FaceMesh& mesh = background.mesh;
    const CornerParameters parameters(model, mesh);
    _support.face = mesh.face;
    _support.points = mesh.points;
    _support.triangles = mesh.triangles;
    for (const auto& triangle : mesh.triangles) _support.corner_uv.push_back(parameters(triangle));
    _curve_vertex = background.on_curves;
    _curve_vertex.resize(mesh.points.size(), -1);
  }

  /// Divides the edges on CAD curves at the fine vertices.
  void insert_curve_vertices() {
    const FineSegments segments(_model, _curves, _background.curves, _support.face);
    const auto twins = match_half_edges(_support.triangles);
    std::vector<EdgePoint> divisions;
    for (SupportHalfEdge h = 0; h < static_cast<SupportHalfEdge>(twins.size()); ++h) {
      if (twins[h] >= 0) continue;
      const std::int32_t a = start_of(_support, h), b = end_of(_support, h);
      const auto inside = segments.between(_curve_vertex[a], _curve_vertex[b]);
      std::vector<double> along{0};
      Vec3 last = _support.points[a];
      for (const CurveVertex v : inside) {
        along.push_back(along.back() + distance(last, _curves.points[v]));
        last = _curves.points[v];
      }
      const double length = along.back() + distance(last, _support.points[b]);
      for (std::size_t i = 0; i < inside.size(); ++i) {
        const double fraction = along[i + 1] / length;
        const Vec2 guess = (1 - fraction) * start_uv(_support, h) + fraction * end_uv(_support, h);
        divisions.push_back({h, fraction, add_point(_curves.points[inside[i]], inside[i]),
                             settle(_curves.points[inside[i]], guess)});
      }
    }
    carry_over(divide_edges(_support, std::move(divisions)), _part);
  }

  /// Adds points on the surface where it turns much along an edge inside.
  void follow_surface() {
    if (_model.is_planar(_support.face)) return;
    for (int round = 0; round < dividing_rounds; ++round) {
      const auto twins = match_half_edges(_support.triangles);
      std::vector<EdgePoint> divisions;
      for (SupportHalfEdge h = 0; h < static_cast<SupportHalfEdge>(twins.size()); ++h) {
        if (twins[h] < h) continue;
        if (!turns(h) && !turns(twins[h])) continue;
        const Vec2 middle = 0.5 * (start_uv(_support, h) + end_uv(_support, h));
        const Vec2 beyond = 0.5 * (start_uv(_support, twins[h]) + end_uv(_support, twins[h]));
        const Vec3 point = _model.face_point(_support.face, _model.wrap(_support.face, middle));
        const std::int32_t index = add_point(point, -1);
        divisions.push_back({h, 0.5, index, middle});
        divisions.push_back({twins[h], 0.5, index, beyond});
      }
      if (divisions.empty()) break;
      carry_over(divide_edges(_support, std::move(divisions)), _part);
    }
  }

  Support finish(FaceVertices& vertices) {
    std::vector<std::pair<CurveVertex, std::int32_t>> known;
    for (std::size_t p = 0; p < _curve_vertex.size(); ++p) {
      if (_curve_vertex[p] >= 0) known.push_back({_curve_vertex[p], static_cast<std::int32_t>(p)});
    }
    std::sort(known.begin(), known.end());
    _support.mesh_vertex.assign(_support.points.size(), -1);
    vertices = {};
    for (const auto& [vertex, point] : known) {
      _support.mesh_vertex[point] = vertices.border_count();
      vertices.tokens.push_back(_curves.token(_model, vertex));
      vertices.points.push_back(_curves.points[vertex]);
      vertices.uv.emplace_back();
    }
    for (std::size_t t = 0; t < _support.triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t vertex = _support.mesh_vertex[_support.triangles[t][i]];
        if (vertex >= 0) vertices.uv[vertex] = _model.wrap(_support.face, _support.corner_uv[t][i]);
      }
    }
    return std::move(_support);
  }

private:
  std::int32_t add_point(Vec3 point, CurveVertex vertex) {
    _support.points.push_back(point);
    _curve_vertex.push_back(vertex);
    return static_cast<std::int32_t>(_support.points.size()) - 1;
  }

  /// Parameters of a point on the face, near the guess and on its side of a seam.
  Vec2 settle(Vec3 point, Vec2 guess) const {
    const auto found = _model.project(_support.face, point, _model.wrap(_support.face, guess));
    if (!found.converged) return guess;
    const Vec2 periods = _model.parameter_periods(_support.face);
    return {unwrap(found.uv.x, guess.x, periods.x), unwrap(found.uv.y, guess.y, periods.y)};
  }

  bool turns(SupportHalfEdge h) const {
    const auto normal = [&](Vec2 uv) {
      return _model.face_frame(_support.face, _model.wrap(_support.face, uv)).normal;
    };
    const Vec3 first = normal(start_uv(_support, h)), second = normal(end_uv(_support, h));
    return norm(first) > 0 && norm(second) > 0 && dot(first, second) < std::cos(facet_turn);
  }

  const Model& _model;
  const FaceBackground& _background;
  const CurveMesh& _curves;
  std::vector<std::int32_t>& _part;
  Support _support;
  std::vector<CurveVertex> _curve_vertex;  // per point; -1: none
};

}  // namespace

std::optional<FaceBackground> mesh_background(const Model& model, geometry::FaceId face,
                                              const CurveMesh& curves, const geometry::Facets& facets,
                                              const sizing::SizeField& coarse, double factor,
                                              const SurfaceOptions& options) {
  FaceBackground background;
  background.curves = coarsen_curves(model, curves, face, factor, largest_turn);
  FaceVertices vertices;
  Support support = build_support(model, face, background.curves.curves, facets, vertices);
  const SupportMeshing meshing{.chart_spread = options.chart_spread,
                               .largest_turn = largest_turn,
                               .remeshing = {.sweeps = smoothing_sweeps, .resizes = false}};
  try {
    background.mesh = mesh_support(model, coarse, std::move(support), vertices, meshing);
  } catch (const FaceConflict&) {
    return std::nullopt;
  }
  for (const mesh::SharedToken token : vertices.tokens) {
    background.on_curves.push_back(background.curves.fine_vertex[background.curves.curves.vertex_of(token)]);
  }
  return background;
}

Support support_of(const Model& model, const FaceBackground& background, const CurveMesh& curves,
                   std::vector<std::int32_t>& part, FaceVertices& vertices) {
  SupportBuilder builder(model, background, curves, part);
  builder.insert_curve_vertices();
  builder.follow_surface();
  return builder.finish(vertices);
}

}  // namespace aeroloom::surface
