#include "surface/curves/sharp_corners.hpp"

#include "parallel/observation/timers.hpp"
#include "sizing/field/closed_corners.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace aeroloom::surface {
namespace {

using cad::FaceCorner;
using cad::Model;

/// Degrees, as where sizes look for sharp corners (sizing/features/corner_sources.cpp).
constexpr double sharp = 30;
/// As above, in apexes of two faces. Chosen, not measured.
constexpr double sharp_apex = 100;
/// A leg ends where the gap between the edges is this fraction of the size there. Chosen, not measured.
constexpr double fitting = 0.8;
/// In apexes of two faces: longer edges than 1.4 sizes are divided (remesh.hpp), so that none spans half a
/// cone.
constexpr double fitting_apex = 1.6;
/// Legs are sought in steps of this ratio, from the size at the corner on. Chosen, not measured.
constexpr double step = 1.1;
constexpr int most_steps = 36;  // to 31 times the size at the corner
/// An edge turns less than this along a leg (degrees). Chosen, not measured.
constexpr double straight = 10;

/// Whether the edge stays close to its chord up to the parameter.
bool is_straight(const Model& model, cad::EdgeEnd end, double parameter, geometry::Vec3 point) {
  const cad::Edge& edge = model.edge(end.edge);
  const double from = end.first ? edge.first_parameter : edge.last_parameter;
  const geometry::Vec3 chord = point - model.edge_point(end.edge, from);
  const double cosine = std::cos(straight * std::numbers::pi / 180);
  for (const double t : {from, parameter}) {
    const geometry::Vec3 tangent = model.edge_tangent(end.edge, t);
    if (std::abs(dot(tangent, chord)) < cosine * norm(tangent) * norm(chord)) return false;
  }
  return true;
}

std::optional<SharpCorner> examine(const Model& model, const sizing::SizeField& field,
                                   const FaceCorner& corner) {
  SharpCorner result{corner.face,
                     corner.vertex,
                     {end_at_corner(corner.arriving, false), end_at_corner(corner.leaving, true)}};
  double distance_along = field(model.vertex(corner.vertex));
  const double closed = sizing::closing_angle(model, corner);
  const bool is_apex = is_apex_of_two_faces(model, corner, distance_along);
  for (int k = 0; k < most_steps; ++k, distance_along *= step) {
    const auto opening = cad::open_corner(model, corner, distance_along);
    if (!opening || opening->degrees >= (is_apex ? sharp_apex : sharp)) break;
    if (k == 0) result.degrees = opening->degrees;
    bool both_straight = true;
    for (int i = 0; i < 2; ++i)
      both_straight &= is_straight(model, result.ends[i], opening->parameters[i], opening->points[i]);
    if (!both_straight) break;
    const double size = std::min(field(opening->points[0]), field(opening->points[1]));
    if (opening->width >= (is_apex ? fitting_apex : fitting) * size) {
      if (opening->degrees >= closed) result.leg = distance_along;
      break;
    }
  }
  if (!(result.degrees > 0)) return std::nullopt;
  result.closes = result.degrees < closed && !(result.leg > 0);
  return result;
}

}  // namespace

cad::FaceId face_beyond_both_edges(const Model& model, const FaceCorner& corner) {
  const auto &arriving = model.edge(corner.arriving.edge), &leaving = model.edge(corner.leaving.edge);
  if (corner.arriving.edge == corner.leaving.edge || arriving.faces.size() != 2) return cad::no_entity;
  if (arriving.faces != leaving.faces) return cad::no_entity;
  return arriving.faces[arriving.faces[0] == corner.face ? 1 : 0];
}

bool is_apex_of_two_faces(const Model& model, const FaceCorner& corner, double distance) {
  const cad::FaceId other = face_beyond_both_edges(model, corner);
  if (other == cad::no_entity) return false;
  for (const FaceCorner& beyond : cad::corners_of(model, other)) {
    if (beyond.vertex == corner.vertex) return cad::open_corner(model, beyond, distance).has_value();
  }
  return false;
}

std::vector<SharpCorner> find_sharp_corners(const Model& model, const sizing::SizeField& field) {
  const parallel::Communicator& communicator = field.communicator();
  std::vector<SharpCorner> corners;
  parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
    for (cad::FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      for (const FaceCorner& corner : cad::corners_of(model, f)) {
        if (const auto found = examine(model, field, corner)) corners.push_back(*found);
      }
    }
  });
  corners = communicator.all_gather_items<SharpCorner>(corners);
  std::stable_sort(corners.begin(), corners.end(),
                   [](const SharpCorner& a, const SharpCorner& b) { return a.face < b.face; });
  return corners;
}

void shorten_legs(const Model& model, const sizing::SizeField& field, std::span<const cad::VertexId> vertices,
                  std::vector<SharpCorner>& corners) {
  for (SharpCorner& corner : corners) {
    if (!std::binary_search(vertices.begin(), vertices.end(), corner.vertex)) continue;
    corner.leg = std::min(corner.leg, longest_short_leg * field(model.vertex(corner.vertex)));
  }
}

std::vector<std::array<double, 2>> legs_of_edges(const Model& model,
                                                 const std::vector<SharpCorner>& corners) {
  std::vector<double> longest(model.vertex_count(), 0);
  for (const SharpCorner& corner : corners)
    longest[corner.vertex] = std::max(longest[corner.vertex], corner.leg);
  std::vector<std::array<double, 2>> result(model.edge_count(), {0, 0});
  for (const SharpCorner& corner : corners) {
    if (!(corner.leg > 0)) continue;
    for (const cad::EdgeEnd& end : corner.ends) result[end.edge][end.first ? 0 : 1] = longest[corner.vertex];
  }
  return result;
}

}  // namespace aeroloom::surface
