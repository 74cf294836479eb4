#include "cad/model/topology/border_path.hpp"

#include "cad/model/evaluation/point_locator.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::cad {
namespace {

/// Of each edge: lengths of arcs are then right to 3e-5 on a full circle, and searches for feet start near
/// them.
constexpr int intervals = 256;

}  // namespace

BorderPath::BorderPath(const Model& model, const std::vector<BorderEdge>& chain)
    : _model(&model), _chain(&chain), _joints{0} {
  for (const BorderEdge& each : chain) {
    const EdgeId id = each.strip_use.edge;
    const Edge& edge = model.edge(id);
    if (_vertices.empty()) _vertices.push_back(each.against ? edge.last : edge.first);
    double from = edge.first_parameter, to = edge.last_parameter;
    if (each.against) std::swap(from, to);
    double passed = _joints.back();
    for (int i = 0; i <= intervals; ++i) {
      const double fraction = static_cast<double>(i) / intervals;
      const double parameter = i == intervals ? to : from + fraction * (to - from);
      const Vec3 point = model.edge_point(id, parameter);
      if (i > 0) passed += distance(point, _samples.back().point);
      _samples.push_back({passed, parameter, point});
    }
    _joints.push_back(passed);
    _vertices.push_back(each.against ? edge.first : edge.last);
  }
}

BorderPath::ChainPlace BorderPath::at(double passed, std::size_t edge) const {
  const auto begin = _samples.begin() + static_cast<std::ptrdiff_t>(edge * (intervals + 1));
  const auto end = begin + intervals + 1;
  const auto above = std::upper_bound(
      begin + 1, end - 1, passed, [](double value, const Sample& sample) { return value < sample.passed; });
  const Sample &low = *(above - 1), &high = *above;
  const double part = high.passed - low.passed;
  const double fraction = part > 0 ? std::clamp((passed - low.passed) / part, 0.0, 1.0) : 0;
  ChainPlace place{edge, low.parameter + fraction * (high.parameter - low.parameter), {}};
  if (fraction == 1) place.parameter = high.parameter;
  place.point = _model->edge_point((*_chain)[edge].strip_use.edge, place.parameter);
  return place;
}

double BorderPath::passed_at(std::size_t edge, double parameter) const {
  const auto begin = _samples.begin() + static_cast<std::ptrdiff_t>(edge * (intervals + 1));
  const double from = begin->parameter, to = (begin + intervals)->parameter;
  const double place = std::clamp((parameter - from) / (to - from), 0.0, 1.0) * intervals;
  const int i = std::min(static_cast<int>(place), intervals - 1);
  return begin[i].passed + (place - i) * (begin[i + 1].passed - begin[i].passed);
}

BorderPath::ChainPlace BorderPath::at(double passed) const {
  const auto above = std::upper_bound(_joints.begin() + 1, _joints.end() - 1, passed);
  return at(passed, static_cast<std::size_t>(above - _joints.begin()) - 1);
}

BorderPath::ChainPlace BorderPath::nearest(Vec3 point) const {
  ChainPlace best;
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i + 1 < _samples.size(); ++i) {
    if ((i + 1) % (intervals + 1) == 0) continue;  // from one edge to the next
    const Sample &low = _samples[i], &high = _samples[i + 1];
    const Vec3 along = high.point - low.point;
    const double square = dot(along, along);
    const double fraction = square > 0 ? std::clamp(dot(point - low.point, along) / square, 0.0, 1.0) : 0;
    const double away = distance(point, low.point + fraction * along);
    if (away >= least) continue;
    least = away;
    best.edge = i / (intervals + 1);
    best.parameter = low.parameter + fraction * (high.parameter - low.parameter);
  }
  const EdgeFoot foot = foot_on_edge(*_model, (*_chain)[best.edge].strip_use.edge, point, best.parameter);
  best.parameter = foot.parameter, best.point = foot.point;
  return best;
}

}  // namespace aeroloom::cad
