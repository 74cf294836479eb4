#include "surface/curves/free_curves.hpp"

#include "mesh/data/shared_vertex_keys.hpp"
#include "surface/curves/curve_metric.hpp"
#include "surface/curves/curves.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// A CAD edge whose ends have moved.
class MovedCurve {
public:
  MovedCurve(const cad::Model& model, cad::EdgeId id, Vec3 first, Vec3 last)
      : _model(model),
        _id(id),
        _edge(model.edge(id)),
        _first(first - model.vertex(_edge.first)),
        _last(last - model.vertex(_edge.last)) {}

  bool has_moved() const { return !(_first == Vec3{} && _last == Vec3{}); }
  /// A coordinate in which neither end has moved keeps its bits.
  Vec3 point(double t) const {
    const double along = (t - _edge.first_parameter) / (_edge.last_parameter - _edge.first_parameter);
    return _model.edge_point(_id, t) + ((1 - along) * _first + along * _last);
  }
  MetricLength metric_length(const sizing::SizeField& field) const {
    const Vec3 stretch = (_last - _first) / (_edge.last_parameter - _edge.first_parameter);
    const auto density = [this, &field, stretch](double t) {
      return norm(_model.edge_tangent(_id, t) + stretch) / field(point(t));
    };
    return {density, _model.edge_breaks(_id)};
  }

private:
  const cad::Model& _model;
  cad::EdgeId _id;
  const cad::Edge& _edge;
  Vec3 _first, _last;  // how far the ends have moved
};

bool contains(const FaceLoops& loops, mesh::SharedVertexKey key) {
  return std::binary_search(loops.vertex_keys.begin(), loops.vertex_keys.end(), key);
}

/// Both ends, the first vertex inside the edge among those of the loops, and their number, at least 1.
struct Chain {
  std::int32_t first_end, last_end, first_inside, inside;
};

/// The vertex that stands for a CAD vertex at the end of a chain: a side of it, where faces part the space
/// there.
std::int32_t end_of_chain(const FaceLoops& loops, mesh::SharedVertexKey vertex, std::int32_t inside) {
  for (const std::array<std::int32_t, 2>& edge : loops.edges) {
    for (const int i : {0, 1}) {
      if (edge[i] == inside && mesh::vertex_key_of_side(loops.vertex_keys[edge[1 - i]]) == vertex)
        return edge[1 - i];
    }
  }
  return contains(loops, vertex) ? loops.find(vertex) : -1;
}

std::optional<Chain> find_chain(const cad::Model& model, cad::EdgeId id, const FaceLoops& loops) {
  const cad::Edge& edge = model.edge(id);
  const auto first = mesh::cad_vertex_key(edge.first), last = mesh::cad_vertex_key(edge.last);
  if (edge.first == edge.last) return std::nullopt;
  // Keys ascend by edge, then along it; some are missing where vertices have become one with others.
  const std::int32_t begin = loops.find(mesh::curve_vertex_key(id, 0));
  const std::int32_t end = loops.find(mesh::curve_vertex_key(id + 1, 0));
  for (std::int32_t v = begin; v < end; ++v) {
    if (mesh::index_of_vertex_key(loops.vertex_keys[v]) != v - begin) return std::nullopt;
  }
  if (begin == end) return std::nullopt;
  const std::int32_t first_end = end_of_chain(loops, first, begin),
                     last_end = end_of_chain(loops, last, end - 1);
  if (first_end < 0 || last_end < 0) return std::nullopt;
  return Chain{first_end, last_end, begin, end - begin};
}

}  // namespace

void spread_on_free_curves(const cad::Model& model, const sizing::SizeField& field, cad::FaceId face,
                           std::span<const cad::FaceId> faces, FaceLoops& loops) {
  for (const auto& loop : model.face(face).loops) {
    for (const cad::Coedge& use : loop) {
      const cad::Edge& edge = model.edge(use.edge);
      const bool is_free = std::all_of(edge.faces.begin(), edge.faces.end(), [&](cad::FaceId other) {
        return std::binary_search(faces.begin(), faces.end(), other);
      });
      if (!is_free || !is_constraining(model, use.edge)) continue;
      const std::optional<Chain> chain = find_chain(model, use.edge, loops);
      if (!chain) continue;
      const MovedCurve curve(model, use.edge, loops.points[chain->first_end], loops.points[chain->last_end]);
      if (!curve.has_moved()) continue;
      const std::vector<double> parameters = equal_parts(curve.metric_length(field), chain->inside + 1);
      for (std::int32_t i = 0; i < chain->inside; ++i)
        loops.points[chain->first_inside + i] = curve.point(parameters[i]);
    }
  }
}

}  // namespace aeroloom::surface
