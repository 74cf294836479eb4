#include "pipeline/edge_turns.hpp"

#include "layers/ridges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace aeroloom::pipeline {
namespace {

// Chosen, not measured.
constexpr int places = 7;
/// An edge that turns by this much goes on with a sharp one that it meets.
constexpr double going_on = std::numbers::pi / 6;

/// The faces that use an edge, and how; a face twice at a seam.
std::vector<std::vector<std::pair<cad::FaceId, cad::Coedge>>> uses_of_edges(const cad::Model& model) {
  std::vector<std::vector<std::pair<cad::FaceId, cad::Coedge>>> uses(model.edge_count());
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    for (const std::vector<cad::Coedge>& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop) uses[use.edge].emplace_back(face, use);
    }
  }
  return uses;
}

/// The largest turn at some places along an edge, in radians; negative where that is not known.
double largest_turn(const cad::Model& model, cad::EdgeId id,
                    const std::vector<std::pair<cad::FaceId, cad::Coedge>>& uses) {
  const cad::Edge& edge = model.edge(id);
  if (uses.size() != 2 || edge.degenerate) return -1;
  if (model.is_faceted(uses[0].first) || model.is_faceted(uses[1].first)) return -1;
  double largest = 0;
  for (int i = 1; i <= places; ++i) {
    const double parameter =
        edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / (places + 1);
    const auto normal = [&](const auto& use) {
      return model.face_frame(use.first, model.edge_uv(use.first, use.second, parameter)).normal;
    };
    const geometry::Vec3 one = normal(uses[0]), other = normal(uses[1]);
    if (one == geometry::Vec3{} || other == geometry::Vec3{}) continue;  // a singular point
    const double cosine = dot(one, other);
    largest = std::max(largest, std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  return largest;
}

}  // namespace

std::vector<layers::EdgeTurn> find_edge_turns(const cad::Model& model) {
  using layers::EdgeTurn;
  const auto uses = uses_of_edges(model);
  std::vector<double> turns;
  std::vector<EdgeTurn> found;
  std::vector<std::uint8_t> ends_sharp(model.vertex_count(), 0);  // by vertex
  const auto make_sharp = [&](std::size_t e) {
    const cad::Edge& edge = model.edge(static_cast<cad::EdgeId>(e));
    found[e] = EdgeTurn::sharp;
    ends_sharp[edge.first] = ends_sharp[edge.last] = 1;
  };
  for (std::size_t e = 0; e < uses.size(); ++e) {
    turns.push_back(largest_turn(model, static_cast<cad::EdgeId>(e), uses[e]));
    found.push_back(turns[e] < 0 ? EdgeTurn::unknown : EdgeTurn::smooth);
    if (turns[e] >= layers::sharp_turn) make_sharp(e);
  }
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t e = 0; e < uses.size(); ++e) {
      const cad::Edge& edge = model.edge(static_cast<cad::EdgeId>(e));
      if (found[e] != EdgeTurn::smooth || turns[e] < going_on) continue;
      if (ends_sharp[edge.first] == 0 && ends_sharp[edge.last] == 0) continue;
      make_sharp(e);
      goes_on = true;
    }
  }
  return found;
}

}  // namespace aeroloom::pipeline
