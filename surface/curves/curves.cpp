#include "surface/curves/curves.hpp"

#include "cad/model/evaluation/face_corners.hpp"
#include "geometry/angle.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/schedule.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/closed_corners.hpp"
#include "surface/curves/curve_metric.hpp"
#include "surface/curves/curve_segments.hpp"
#include "surface/curves/cusp_alignment.hpp"

#include <algorithm>
#include <optional>

namespace aeroloom::surface {
namespace {

using cad::Edge;
using cad::EdgeId;
using cad::Model;
using geometry::Vec3;

/// An interior vertex as it travels between ranks.
struct PlacedVertex {
  EdgeId edge;
  std::int32_t rank_on_edge;
  double parameter;
  Vec3 point;
};

/// The part of an edge between its legs, where the field alone spreads vertices.
struct FreeStretch {
  double from, to;  // parameters
  int legs = 0;

  bool has_leg_at_first(const Edge& edge) const { return from > edge.first_parameter; }
  bool has_leg_at_last(const Edge& edge) const { return to < edge.last_parameter; }
};

FreeStretch between_legs(const Model& model, EdgeId id, const std::array<double, 2>& legs) {
  const Edge& edge = model.edge(id);
  FreeStretch stretch{edge.first_parameter, edge.last_parameter};
  if (legs[0] > 0) stretch.from = cad::parameter_at(model, {id, true}, legs[0]).value_or(stretch.from);
  if (legs[1] > 0) stretch.to = cad::parameter_at(model, {id, false}, legs[1]).value_or(stretch.to);
  if (!(stretch.from < stretch.to)) return {edge.first_parameter, edge.last_parameter};
  stretch.legs = (stretch.has_leg_at_first(edge) ? 1 : 0) + (stretch.has_leg_at_last(edge) ? 1 : 0);
  return stretch;
}

MetricLength metric_length(const Model& model, const sizing::SizeField& field, EdgeId edge,
                           const FreeStretch& stretch) {
  auto density = [&model, &field, edge](double t) {
    return geometry::norm(model.edge_tangent(edge, t)) / field(model.edge_point(edge, t));
  };
  std::vector<double> breaks{stretch.from};
  for (const double t : model.edge_breaks(edge)) {
    if (t > stretch.from && t < stretch.to) breaks.push_back(t);
  }
  breaks.push_back(stretch.to);
  return {density, breaks};
}

/// A cheap guess of the segments of an edge, as its load.
double estimate_load(const Model& model, const sizing::SizeField& field, EdgeId id) {
  constexpr int chords = 8;  // rough: loads are distributed by it, no result depends on it
  const Edge& edge = model.edge(id);
  Vec3 from = model.edge_point(id, edge.first_parameter);
  double load = 1;
  for (int i = 1; i <= chords; ++i) {
    const double t = edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / chords;
    const Vec3 to = model.edge_point(id, t);
    load += geometry::distance(from, to) / field(0.5 * (from + to));
    from = to;
  }
  return load;
}

/// Length, chord and turning of an edge beside its length in the metric.
EdgeMeasure measure_edge(const Model& model, EdgeId id, const MetricLength& length, int legs) {
  constexpr int samples = 32;  // chosen, not measured
  const Edge& edge = model.edge(id);
  const double between = legs > 0 ? std::max(1.0, length.total()) : length.total();
  EdgeMeasure measure{id, between + legs, 0, 0, 0};
  std::optional<Vec3> direction;
  Vec3 from = model.edge_point(id, edge.first_parameter);
  const Vec3 start = from;
  for (int i = 1; i <= samples; ++i) {
    const double t = edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / samples;
    const Vec3 to = model.edge_point(id, t);
    const Vec3 step = to - from;
    measure.length += geometry::norm(step);
    if (geometry::norm(step) > 0) {
      const Vec3 now = geometry::normalized(step);
      if (direction) measure.turning += angle_between(*direction, now);
      direction = now;
    }
    from = to;
  }
  measure.chord = geometry::distance(start, from);
  return measure;
}

std::vector<PlacedVertex> place_vertices(const Model& model, EdgeId id, const MetricLength& length,
                                         const FreeStretch& stretch, int segments) {
  const Edge& edge = model.edge(id);
  std::vector<double> parameters = equal_parts(length, segments - stretch.legs);
  if (stretch.has_leg_at_first(edge)) parameters.insert(parameters.begin(), stretch.from);
  if (stretch.has_leg_at_last(edge)) parameters.push_back(stretch.to);
  // An edge without length still gets distinct parameters.
  if (!(length.total() > 0)) {
    for (int i = 1; i < segments; ++i)
      parameters[i - 1] = edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / segments;
  }
  std::vector<PlacedVertex> placed;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    placed.push_back({id, static_cast<std::int32_t>(i), parameters[i], model.edge_point(id, parameters[i])});
  return placed;
}

/// Joins what the ranks placed; vertices by edge, then along it.
CurveMesh assemble(const Model& model, std::vector<PlacedVertex> placed) {
  std::sort(placed.begin(), placed.end(), [](const PlacedVertex& a, const PlacedVertex& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.rank_on_edge < b.rank_on_edge;
  });
  CurveMesh mesh;
  for (cad::VertexId v = 0; v < model.vertex_count(); ++v) mesh.points.push_back(model.vertex(v));
  mesh.first_interior.assign(model.edge_count() + 1, model.vertex_count());
  for (const PlacedVertex& vertex : placed) {
    mesh.points.push_back(vertex.point);
    mesh.parameters.push_back(vertex.parameter);
    ++mesh.first_interior[vertex.edge + 1];
  }
  for (EdgeId e = 0; e < model.edge_count(); ++e)
    mesh.first_interior[e + 1] += mesh.first_interior[e] - model.vertex_count();
  return mesh;
}

}  // namespace

std::vector<CurveVertex> CurveMesh::chain(const Model& model, EdgeId id) const {
  if (!is_constraining(model, id)) return {};
  std::vector<CurveVertex> vertices{model.edge(id).first};
  for (CurveVertex v = first_interior[id]; v < first_interior[id + 1]; ++v) vertices.push_back(v);
  vertices.push_back(model.edge(id).last);
  return vertices;
}

std::vector<double> CurveMesh::chain_parameters(const Model& model, EdgeId id) const {
  if (!is_constraining(model, id)) return {};
  std::vector<double> result{model.edge(id).first_parameter};
  for (CurveVertex v = first_interior[id]; v < first_interior[id + 1]; ++v)
    result.push_back(parameters[v - model.vertex_count()]);
  result.push_back(model.edge(id).last_parameter);
  return result;
}

EdgeId CurveMesh::edge_of(const Model& model, CurveVertex v) const {
  if (v < model.vertex_count()) return cad::no_entity;
  return static_cast<EdgeId>(std::upper_bound(first_interior.begin(), first_interior.end(), v) -
                             first_interior.begin()) -
         1;
}

mesh::SharedVertexKey CurveMesh::vertex_key(const Model& model, CurveVertex v) const {
  if (v < model.vertex_count()) return mesh::cad_vertex_key(v);
  const EdgeId edge = edge_of(model, v);
  return mesh::curve_vertex_key(edge, v - first_interior[edge]);
}

CurveVertex CurveMesh::vertex_of(mesh::SharedVertexKey vertex_key) const {
  const EdgeId edge = mesh::edge_of_vertex_key(vertex_key);
  const CurveVertex index = mesh::index_of_vertex_key(vertex_key);
  return edge == cad::no_entity ? index : first_interior[edge] + index;
}

bool is_constraining(const Model& model, EdgeId id) {
  const Edge& edge = model.edge(id);
  if (edge.degenerate) return false;
  return !edge.faces.empty() && !model.is_seam(id);
}

CurveMesh discretise_curves(const Model& model, const sizing::SizeField& field,
                            std::span<const cad::VertexId> short_legs) {
  const parallel::Communicator& communicator = field.communicator();
  std::vector<EdgeId> edges;
  std::vector<double> loads;
  std::vector<EdgeId> mine;
  std::vector<MetricLength> lengths;
  std::vector<EdgeMeasure> measures;
  std::vector<FreeStretch> stretches;
  std::vector<SharpCorner> corners = find_sharp_corners(model, field);
  shorten_legs(model, field, short_legs, corners);
  const auto legs = legs_of_edges(model, corners);
  parallel::agree(communicator, [&] {
    {
      const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::repeated);
      for (EdgeId e = 0; e < model.edge_count(); ++e) {
        if (!is_constraining(model, e)) continue;
        edges.push_back(e);
        loads.push_back(estimate_load(model, field, e));
      }
    }
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
    const auto assignment = parallel::assign_largest_first(loads, communicator.size());
    for (const int task : parallel::tasks_of_rank(assignment, loads, communicator.rank())) {
      const double begin = parallel::cpu_seconds();
      mine.push_back(edges[task]);
      stretches.push_back(between_legs(model, edges[task], legs[edges[task]]));
      lengths.push_back(metric_length(model, field, edges[task], stretches.back()));
      measures.push_back(measure_edge(model, edges[task], lengths.back(), stretches.back().legs));
      parallel::note_task(
          {parallel::TaskKind::curve, edges[task], loads[task], parallel::cpu_seconds() - begin});
    }
  });
  measures = communicator.all_gather_items(std::span<const EdgeMeasure>(measures));

  std::vector<PlacedVertex> placed;
  parallel::agree(communicator, [&] {
    const std::vector<int> segments = [&] {
      const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::repeated);
      return count_segments(model, std::move(measures));
    }();
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      const auto vertices = place_vertices(model, mine[i], lengths[i], stretches[i], segments[mine[i]]);
      placed.insert(placed.end(), vertices.begin(), vertices.end());
    }
  });
  CurveMesh mesh = assemble(model, communicator.all_gather_items(std::span<const PlacedVertex>(placed)));
  mesh.sharp_corners = std::move(corners);
  parallel::collectively(communicator, parallel::ScopedCpu::As::repeated,
                         [&] { align_cusps(model, sizing::closing_gap(field.options()), mesh); });
  return mesh;
}

}  // namespace aeroloom::surface
