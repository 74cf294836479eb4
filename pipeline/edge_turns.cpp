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
constexpr int places = 9;
/// A sharp edge turns by this much all along: noses of lofted wings are smooth at the sections they are made
/// from, however sharp they are in between. An edge that does goes on with a sharp one that it meets.
constexpr double going_on = std::numbers::pi / 6;

/// The faces that use an edge, and how; a face twice at a seam.
using FaceUses = std::vector<std::pair<cad::FaceId, cad::Coedge>>;

std::vector<FaceUses> uses_of_edges(const cad::Model& model) {
  std::vector<FaceUses> uses(model.edge_count());
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    for (const std::vector<cad::Coedge>& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop) uses[use.edge].emplace_back(face, use);
    }
  }
  return uses;
}

/// The turns at some places along an edge, in radians; negative where they are not known.
struct Turns {
  double least = -1, largest = -1;
  bool is_convex = false;  ///< somewhere, seen from the front regions of the faces
};

Turns turns_along(const cad::Model& model, cad::EdgeId id, const FaceUses& uses, bool is_mirrored) {
  const cad::Edge& edge = model.edge(id);
  if (uses.size() != 2 || edge.degenerate) return {};
  if (model.is_faceted(uses[0].first) || model.is_faceted(uses[1].first)) return {};
  Turns turns{std::numbers::pi, 0};
  for (int i = 0; i < places; ++i) {
    const double parameter =
        edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / (places - 1);
    const auto normal = [&](const auto& use) {
      return model.face_frame(use.first, model.edge_uv(use.first, use.second, parameter)).normal;
    };
    const geometry::Vec3 one = normal(uses[0]), other = normal(uses[1]);
    if (one == geometry::Vec3{} || other == geometry::Vec3{}) continue;  // a singular point
    const double angle = std::acos(std::clamp(dot(one, other), -1.0, 1.0)),
                 turn = is_mirrored ? std::abs(std::numbers::pi - 2 * angle) : angle;
    turns.least = std::min(turns.least, turn);
    turns.largest = std::max(turns.largest, turn);
    const geometry::Vec3 along = model.edge_tangent(id, parameter),
                         into_face = cross(one, uses[0].second.reversed ? -along : along);
    turns.is_convex = turns.is_convex || (is_mirrored ? dot(one, other) : dot(into_face, other)) > 0;
  }
  return turns;
}

/// Whether one of the two faces at an edge is among the planes.
bool is_at_plane(const FaceUses& uses, const std::vector<cad::FaceId>& planes) {
  return std::count_if(uses.begin(), uses.end(), [&](const auto& use) {
           return std::find(planes.begin(), planes.end(), use.first) != planes.end();
         }) == 1;
}

}  // namespace

std::vector<layers::EdgeTurn> find_edge_turns(const cad::Model& model,
                                              const std::vector<cad::FaceId>& planes) {
  using layers::EdgeTurn;
  const auto uses = uses_of_edges(model);
  std::vector<Turns> turns;
  std::vector<EdgeTurn> found;
  std::vector<std::uint8_t> ends_sharp(model.vertex_count(), 0);  // by vertex
  const auto make_sharp = [&](std::size_t e) {
    const cad::Edge& edge = model.edge(static_cast<cad::EdgeId>(e));
    found[e] = EdgeTurn::sharp;
    ends_sharp[edge.first] = ends_sharp[edge.last] = 1;
  };
  for (std::size_t e = 0; e < uses.size(); ++e) {
    turns.push_back(turns_along(model, static_cast<cad::EdgeId>(e), uses[e], is_at_plane(uses[e], planes)));
    found.push_back(turns[e].largest < 0 ? EdgeTurn::unknown : EdgeTurn::smooth);
    if (turns[e].largest >= layers::sharp_turn && turns[e].least >= going_on) make_sharp(e);
  }
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t e = 0; e < uses.size(); ++e) {
      const cad::Edge& edge = model.edge(static_cast<cad::EdgeId>(e));
      if (found[e] != EdgeTurn::smooth || turns[e].least < going_on) continue;
      if (ends_sharp[edge.first] == 0 && ends_sharp[edge.last] == 0) continue;
      make_sharp(e);
      goes_on = true;
    }
  }
  for (std::size_t e = 0; e < uses.size(); ++e) {
    if (found[e] == EdgeTurn::smooth && is_at_plane(uses[e], planes)) found[e] = EdgeTurn::upright;
  }
  return found;
}

std::vector<double> find_ridge_turns(const cad::Model& model, const std::vector<cad::FaceId>& planes) {
  const auto uses = uses_of_edges(model);
  const std::vector<layers::EdgeTurn> kinds = find_edge_turns(model, planes);
  std::vector<double> found(kinds.size(), 0);
  for (std::size_t e = 0; e < kinds.size(); ++e) {
    if (kinds[e] != layers::EdgeTurn::sharp) continue;
    const bool is_half = is_at_plane(uses[e], planes);
    const Turns turns = turns_along(model, static_cast<cad::EdgeId>(e), uses[e], is_half);
    if (turns.is_convex) found[e] = is_half ? 0.5 * turns.largest : turns.largest;
  }
  return found;
}

}  // namespace aeroloom::pipeline
