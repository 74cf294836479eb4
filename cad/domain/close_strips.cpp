#include "cad/domain/close_strips.hpp"

#include "cad/model/topology/closed_edges.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {

ClosedStrips close_strips(const Model& model, std::vector<BluntEdge> strips) {
  const auto attempt = [&](const std::vector<BluntEdge>& some, std::string& reason) -> std::optional<Model> {
    try {
      return close_blunt_edges(model, some);
    } catch (const CadError& error) {
      reason = error.what();
      return std::nullopt;
    }
  };
  std::string reason;
  if (auto closed = attempt(strips, reason)) return {*std::move(closed), std::move(strips), {}};
  ClosedStrips result{model, {}, {}};
  std::stable_sort(strips.begin(), strips.end(),
                   [](const BluntEdge& a, const BluntEdge& b) { return a.length > b.length; });
  for (const BluntEdge& strip : strips) {
    result.closed.push_back(strip);
    if (auto closed = attempt(result.closed, reason)) {
      result.model = *std::move(closed);
      continue;
    }
    result.closed.pop_back();
    result.left.push_back({strip, reason});
  }
  return result;
}

Change describe_closed(const Model& model, const BluntEdge& strip) {
  const auto neighbour = [&](int side) { return model.face(strip.borders[side].front().neighbour).name; };
  return {
      fmt::format("trailing edge '{}', {:.4g} long and at most {:.3g} wide, was closed to a curve half-way "
                  "between '{}' and '{}'",
                  model.face(strip.face).name, strip.length, strip.widest, neighbour(0), neighbour(1)),
      strip.place, 0.5 * strip.widest};
}

}  // namespace aeroloom::cad
