#include "surface/division/background.hpp"

#include "geometry/angle.hpp"
#include "surface/charts/chart_mesher.hpp"
#include "surface/charts/parameters.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/division/boundary_thinning.hpp"
#include "surface/surface_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec2;
using geometry::Vec3;

/// Of curves and of the surface along an edge of the background. Chosen, not measured.
constexpr double largest_turn = 30 * geometry::degree;
/// Edges of the background are as long as so many fine ones at least, however much the surface turns: a
/// coarser mesh is its point.
constexpr double fine_edges = 2;
constexpr int smoothing_sweeps = 3;  // it carries cuts, it is no mesh: a few do
/// Facets of the chart surface turn less than this: edges between points whose normals differ by more are
/// divided, in so many rounds.
constexpr double facet_turn = 12 * geometry::degree;
constexpr int dividing_rounds = 3;

/// Parameters at the corners of each triangle, without jumps inside it: those of vertices across a seam are
/// moved by a period, and the direction that means nothing at a pole is taken from the other corners. A
/// triangle around a pole, or across sheets of a joined face, gets those of one corner everywhere: there is
/// no better linear guess.
class CornerParameters {
public:
  CornerParameters(const Model& model, const FaceMesh& mesh)
      : _model(model), _mesh(mesh), _collapsed(mesh.points.size()) {
    if (model.is_planar(mesh.face)) return;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const cad::SurfaceFrame frame = model.face_frame(mesh.face, mesh.uv[v]);
      const double u = norm(frame.du), v_length = norm(frame.dv);
      constexpr double vanishing = 1e-6;  // one derivative next to the other; at a pole; chosen, not measured
      _collapsed[v] = {u <= vanishing * v_length, v_length <= vanishing * u};
    }
  }

  std::array<Vec2, 3> operator()(const std::array<std::int32_t, 3>& triangle) const {
    const Vec2 first = _mesh.uv[triangle[0]];
    for (const std::int32_t v : triangle) {
      if (_model.sheet(_mesh.face, _mesh.uv[v]) != _model.sheet(_mesh.face, first))
        return {first, first, first};
    }
    const Vec2 periods = _model.parameter_periods(_mesh.face, first);
    std::array<Vec2, 3> uv;
    std::array<std::array<double, 3>, 2> values;
    for (int direction = 0; direction < 2; ++direction) {
      const double period = direction == 0 ? periods.x : periods.y;
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
    if (goes_round(values[0], periods.x) || goes_round(values[1], periods.y)) uv[1] = uv[2] = uv[0];
    return uv;
  }

private:
  static bool goes_round(const std::array<double, 3>& values, double period) {
    constexpr double part = 0.4;  // of a period; three triangles around a tube span a third each
    const auto [low, high] = std::minmax({values[0], values[1], values[2]});
    return period > 0 && high - low > part * period;
  }

  const Model& _model;
  const FaceMesh& _mesh;
  std::vector<std::array<bool, 2>> _collapsed;  // per vertex: u means nothing there, v means nothing there
};

void carry_over(const std::vector<std::int32_t>& former, std::vector<std::int32_t>& part) {
  std::vector<std::int32_t> now;
  now.reserve(former.size());
  for (const std::int32_t t : former) now.push_back(part[t]);
  part = std::move(now);
}

/// Builds the chart surface step by step.
class ChartSurfaceBuilder {
public:
  ChartSurfaceBuilder(const Model& model, const PieceProblem& problem, const Background& background,
                      std::vector<std::int32_t>& part)
      : _model(model), _problem(problem), _loops(background.loops), _part(part) {
    const FaceMesh& mesh = background.mesh;
    const CornerParameters parameters(model, mesh);
    _surface.face = mesh.face;
    _surface.points = mesh.points;
    _surface.triangles = mesh.triangles;
    for (const auto& triangle : mesh.triangles) _surface.corner_uv.push_back(parameters(triangle));
    _surface.mesh_vertex = background.on_loops;
    _surface.mesh_vertex.resize(mesh.points.size(), -1);
    if (mesh.slits.empty()) return;
    const std::vector<std::int32_t> all(mesh.triangles.size(), 0);
    _surface = std::move(separate_parts(_surface, open_half_edges(mesh), all, 1).front());
  }

  /// Divides the edges on loops at the fine vertices.
  void insert_loop_vertices() {
    const auto twins = geometry::match_half_edges(_surface.triangles);
    std::vector<EdgePoint> divisions;
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
      if (twins[h] < 0) divide_loop_edge(h, divisions);
    }
    carry_over(divide_edges(_surface, std::move(divisions)), _part);
  }

  /// Adds points on the surface where it turns much along an edge inside.
  void follow_surface() {
    if (_model.is_planar(_surface.face)) return;
    for (int round = 0; round < dividing_rounds; ++round) {
      const auto twins = geometry::match_half_edges(_surface.triangles);
      std::vector<EdgePoint> divisions;
      for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
        if (twins[h] < h) continue;
        if (!turns(h) && !turns(twins[h])) continue;
        const Vec3 a = _surface.points[start_of(_surface, h)], b = _surface.points[end_of(_surface, h)];
        const Vec2 guess = 0.5 * (start_uv(_surface, h) + end_uv(_surface, h));
        const auto middle = _model.project(_surface.face, 0.5 * (a + b), _model.wrap(_surface.face, guess));
        if (!middle.converged || distance(middle.point, 0.5 * (a + b)) > 0.5 * distance(a, b)) continue;
        const std::int32_t index = add_point(middle.point, -1);
        divisions.push_back({h, 0.5, index, near(middle.uv, guess)});
        const Vec2 twin_uv = 0.5 * (start_uv(_surface, twins[h]) + end_uv(_surface, twins[h]));
        divisions.push_back({twins[h], 0.5, index, near(middle.uv, twin_uv)});
      }
      if (divisions.empty()) break;
      carry_over(divide_edges(_surface, std::move(divisions)), _part);
    }
  }

  ChartSurface finish() {
    _surface.loop_edges = trace_loop_edges(_surface);
    return std::move(_surface);
  }

private:
  std::int32_t add_point(Vec3 point, std::int32_t vertex) {
    _surface.points.push_back(point);
    _surface.mesh_vertex.push_back(vertex);
    return static_cast<std::int32_t>(_surface.points.size()) - 1;
  }

  void divide_loop_edge(geometry::HalfEdge h, std::vector<EdgePoint>& divisions) {
    const std::int32_t from = _surface.mesh_vertex[start_of(_surface, h)];
    const std::int32_t to = _surface.mesh_vertex[end_of(_surface, h)];
    const CoarseSegment* segment = _loops.find(from, to);
    if (segment == nullptr) return;
    std::vector<std::int32_t> inside(_loops.inside.begin() + segment->begin,
                                     _loops.inside.begin() + segment->end);
    if (segment->from != from) std::reverse(inside.begin(), inside.end());
    std::vector<double> along{0};
    Vec3 last = _problem.vertices.points[from];
    for (const std::int32_t v : inside) {
      along.push_back(along.back() + distance(last, _problem.vertices.points[v]));
      last = _problem.vertices.points[v];
    }
    const double length = along.back() + distance(last, _problem.vertices.points[to]);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const double fraction = along[i + 1] / length;
      const Vec2 guess = (1 - fraction) * start_uv(_surface, h) + fraction * end_uv(_surface, h);
      divisions.push_back({h, fraction, add_point(_problem.vertices.points[inside[i]], inside[i]),
                           near(_problem.vertices.uv[inside[i]], guess)});
    }
  }

  Vec2 near(Vec2 uv, Vec2 others) const { return unwrap(_model, _surface.face, uv, others); }

  bool turns(geometry::HalfEdge h) const {
    const auto normal = [&](Vec2 uv) {
      return _model.face_frame(_surface.face, _model.wrap(_surface.face, uv)).normal;
    };
    const Vec3 first = normal(start_uv(_surface, h)), second = normal(end_uv(_surface, h));
    return norm(first) > 0 && norm(second) > 0 && dot(first, second) < std::cos(facet_turn);
  }

  const Model& _model;
  const PieceProblem& _problem;
  const CoarseLoops& _loops;
  std::vector<std::int32_t>& _part;
  ChartSurface _surface;
};

/// The piece problem without the vertices on loops that the background does without. `on_loops` receives the
/// vertices that stay.
PieceProblem thin_out(const Model& model, const PieceProblem& problem, const CoarseLoops& loops,
                      std::vector<std::int32_t>& on_loops) {
  std::vector<char> keep(problem.vertices.points.size(), 0);
  for (const CoarseSegment& segment : loops.segments) keep[segment.from] = keep[segment.to] = 1;
  PieceProblem thin{problem.surface, {}, problem.load};
  drop_boundary_vertices(model, keep, thin.surface);
  std::vector<std::int32_t> number(keep.size(), -1);
  for (std::size_t v = 0; v < keep.size(); ++v) {
    if (!keep[v]) continue;
    number[v] = static_cast<std::int32_t>(on_loops.size());
    on_loops.push_back(static_cast<std::int32_t>(v));
    thin.vertices.points.push_back(problem.vertices.points[v]);
    thin.vertices.uv.push_back(problem.vertices.uv[v]);
    thin.vertices.vertex_keys.push_back(problem.vertices.vertex_keys[v]);
  }
  for (std::int32_t& v : thin.surface.mesh_vertex) v = v < 0 ? -1 : number[v];
  return thin;
}

}  // namespace

std::optional<Background> mesh_background(const Model& model, const PieceProblem& problem,
                                          const sizing::SizeField& coarse, double factor,
                                          const SurfaceOptions& options) {
  Background background;
  background.loops = coarsen_loops(problem, coarse, largest_turn);
  PieceProblem thin = thin_out(model, problem, background.loops, background.on_loops);
  const ChartMeshing meshing{.chart_spread = options.chart_spread,
                             .largest_turn = largest_turn,
                             .least_fraction = std::min(1.0, fine_edges / factor),
                             .divides_folds = false,  // other sizes, or the face stays whole
                             .remeshing = {.sweeps = smoothing_sweeps, .resizes = false}};
  try {
    background.mesh = mesh_charts(model, coarse, thin.surface, std::move(thin.vertices), meshing);
  } catch (const FaceConflict&) {
    return std::nullopt;
  } catch (const SurfaceError&) {  // no chart under these sizes
    return std::nullopt;
  }
  return background;
}

ChartSurface chart_surface_of(const Model& model, const PieceProblem& problem, const Background& background,
                              std::vector<std::int32_t>& part) {
  ChartSurfaceBuilder builder(model, problem, background, part);
  builder.insert_loop_vertices();
  builder.follow_surface();
  return builder.finish();
}

}  // namespace aeroloom::surface
