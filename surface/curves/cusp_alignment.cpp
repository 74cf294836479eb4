#include "surface/curves/cusp_alignment.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace aeroloom::surface {
namespace {

using cad::EdgeEnd;
using cad::Model;
using geometry::Vec3;

/// Vertices after the last aligned one that share what it moved by. Chosen, not measured.
constexpr int steps_back = 5;

/// Its interior vertices alone.
std::vector<CurveVertex> from_end(const Model& model, const CurveMesh& curves, EdgeEnd end) {
  std::vector<CurveVertex> chain = near_half(model, curves, end);
  chain.erase(chain.begin());
  return chain;
}

/// Distances of vertices from the CAD vertex.
std::vector<double> distances(const CurveMesh& curves, const std::vector<CurveVertex>& vertices, Vec3 from) {
  std::vector<double> result;
  result.reserve(vertices.size());
  for (const CurveVertex v : vertices) result.push_back(distance(curves.points[v], from));
  return result;
}

/// A corner with the curve that leads and the one that follows.
class CuspAlignment {
public:
  CuspAlignment(const Model& model, CurveMesh& curves, cad::VertexId vertex, EdgeEnd leader, EdgeEnd follower)
      : _model(model), _curves(curves), _follower(follower), _at(model.vertex(vertex)) {
    _led = from_end(model, curves, follower);
    _leading = distances(curves, from_end(model, curves, leader), _at);
    _leader = leader;
  }

  void run(double widest) {
    std::vector<double> wanted = distances(_curves, _led, _at);
    const std::size_t most = std::min(wanted.size(), _leading.size());
    double moved = 0;
    std::size_t aligned = 0;
    for (; aligned < most && width_at(_leading[aligned]) < widest; ++aligned) {
      moved = _leading[aligned] - wanted[aligned];
      wanted[aligned] = _leading[aligned];
    }
    for (std::size_t i = aligned; i < std::min(wanted.size(), aligned + steps_back); ++i)
      wanted[i] += moved * (1 - static_cast<double>(i - aligned + 1) / (steps_back + 1));
    if (aligned > 0 && std::is_sorted(wanted.begin(), wanted.end())) place(wanted, aligned + steps_back);
  }

private:
  /// Between the curves, at a distance from the CAD vertex; that distance where one of them ends before.
  double width_at(double distance_along) const {
    const auto a = cad::parameter_at(_model, _leader, distance_along),
               b = cad::parameter_at(_model, _follower, distance_along);
    if (!a || !b) return distance_along;
    return distance(_model.edge_point(_leader.edge, *a), _model.edge_point(_follower.edge, *b));
  }

  void place(const std::vector<double>& wanted, std::size_t count) {
    std::vector<double> parameters;
    for (std::size_t i = 0; i < std::min(count, wanted.size()); ++i) {
      const auto parameter = cad::parameter_at(_model, _follower, wanted[i]);
      if (!parameter) return;
      parameters.push_back(*parameter);
    }
    const bool forward = std::is_sorted(parameters.begin(), parameters.end());
    if (forward != _follower.first || passes_next(parameters)) return;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      _curves.parameters[_led[i] - _model.vertex_count()] = parameters[i];
      _curves.points[_led[i]] = _model.edge_point(_follower.edge, parameters[i]);
    }
  }

  /// Whether the last of the first vertices would lie at the one after them, or beyond it: those of the other
  /// half do not move with them.
  bool passes_next(const std::vector<double>& parameters) const {
    std::vector<double> all = _curves.chain_parameters(_model, _follower.edge);
    if (!_follower.first) std::reverse(all.begin(), all.end());
    const double next = all[parameters.size() + 1];
    return _follower.first ? parameters.back() >= next : parameters.back() <= next;
  }

  const Model& _model;
  CurveMesh& _curves;
  EdgeEnd _leader, _follower;
  Vec3 _at;
  std::vector<CurveVertex> _led;
  std::vector<double> _leading;
};

}  // namespace

std::vector<CurveVertex> near_half(const Model& model, const CurveMesh& curves, EdgeEnd end) {
  std::vector<CurveVertex> chain = curves.chain(model, end.edge);
  if (!end.first) std::reverse(chain.begin(), chain.end());
  chain.resize((chain.size() + 1) / 2);
  return chain;
}

void align_cusps(const Model& model, double widest, CurveMesh& curves) {
  std::map<std::pair<cad::EdgeId, bool>, bool> follows;
  for (const SharpCorner& corner : curves.sharp_corners) {
    if (!corner.closes) continue;
    EdgeEnd leader = corner.ends[0], follower = corner.ends[1];
    if (follower.edge < leader.edge) std::swap(leader, follower);
    if (follows[{follower.edge, follower.first}]) std::swap(leader, follower);
    if (follows[{follower.edge, follower.first}] || leader.edge == follower.edge) continue;
    follows[{follower.edge, follower.first}] = true;
    CuspAlignment(model, curves, corner.vertex, leader, follower).run(widest);
  }
}

}  // namespace aeroloom::surface
