#include "cad/model/evaluation/face_corners.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <stdexcept>

namespace aeroloom::cad {
namespace {

/// The normal of the face at the vertex, or nearby where the surface is singular there.
Vec3 normal_at(const Model& model, const FaceCorner& corner) {
  const EdgeEnd end = end_at_corner(corner.leaving, true);
  const Edge& edge = model.edge(end.edge);
  const double from = end.first ? edge.first_parameter : edge.last_parameter;
  const double to = end.first ? edge.last_parameter : edge.first_parameter;
  for (const double part : {0.0, tolerances::beside_end, tolerances::farther_beside_end}) {
    const Vec2 uv = model.edge_uv(corner.face, corner.leaving, from + part * (to - from));
    const Vec3 normal = model.face_frame(corner.face, uv).normal;
    if (norm(normal) > 0) return normal;
  }
  return {};
}

/// The normal half-way between the edges where a corner is cut off.
Vec3 normal_between(const Model& model, const FaceCorner& corner, const CornerOpening& opening) {
  const Vec2 a = model.edge_uv(corner.face, corner.arriving, opening.parameters[0]);
  const Vec2 b = model.edge_uv(corner.face, corner.leaving, opening.parameters[1]);
  return model.face_frame(corner.face, 0.5 * (a + b)).normal;
}

}  // namespace

std::vector<FaceCorner> corners_of(const Model& model, FaceId id) {
  const Face& face = model.face(id);
  std::vector<FaceCorner> corners;
  for (const auto& whole_loop : face.loops) {
    // At a pole the edges before and after it meet.
    std::vector<Coedge> loop;
    for (const Coedge& use : whole_loop) {
      if (!model.edge(use.edge).degenerate) loop.push_back(use);
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Coedge &arriving = loop[i], &leaving = loop[(i + 1) % loop.size()];
      if (model.is_seam(arriving.edge) || model.is_seam(leaving.edge)) continue;
      const Edge& edge = model.edge(leaving.edge);
      corners.push_back({id, leaving.reversed ? edge.last : edge.first, arriving, leaving});
    }
  }
  return corners;
}

FaceId neighbour_face(const Model& model, FaceId face, EdgeId id) {
  const Edge& edge = model.edge(id);
  if (edge.faces.size() != 2) return no_entity;
  const FaceId other = edge.faces[0] == face ? edge.faces[1] : edge.faces[0];
  int uses = 0;
  for (const Coedge& use : model.face(other).loops | std::views::join) uses += use.edge == id;
  return uses == 1 ? other : no_entity;
}

Coedge coedge_along(const Model& model, FaceId face, EdgeId id) {
  for (const Coedge& use : model.face(face).loops | std::views::join) {
    if (use.edge == id) return use;
  }
  throw std::logic_error("a face does not pass an edge of its neighbour");
}

CornerNeighbours neighbours_at_corner(const Model& model, const FaceCorner& corner) {
  const FaceId first = neighbour_face(model, corner.face, corner.arriving.edge),
               second = neighbour_face(model, corner.face, corner.leaving.edge);
  if (first == no_entity || second == no_entity || first == second) return CornerNeighbours::other;
  for (const Coedge& use : model.face(first).loops | std::views::join) {
    const Edge& edge = model.edge(use.edge);
    const bool at_corner = edge.first == corner.vertex || edge.last == corner.vertex;
    if (at_corner && std::ranges::find(edge.faces, second) != edge.faces.end())
      return CornerNeighbours::faces_that_meet;
  }
  return CornerNeighbours::two_faces;
}

std::optional<double> parameter_at(const Model& model, EdgeEnd end, double wanted) {
  const Edge& edge = model.edge(end.edge);
  const double from = end.first ? edge.first_parameter : edge.last_parameter;
  const double range = (end.first ? edge.last_parameter : edge.first_parameter) - from;
  // Growing by half ends close after the place, and 40 bisections narrow it to 1e-12 of that.
  constexpr double growth = 1.5;
  constexpr int bisections = 40;
  const Vec3 vertex = model.edge_point(end.edge, from);
  const auto is_past = [&](double part) {
    return distance(model.edge_point(end.edge, from + part * range), vertex) >= wanted;
  };
  const double speed = norm(model.edge_tangent(end.edge, from)) * std::abs(range);
  double high =
             speed > 0 ? std::clamp(wanted / speed, tolerances::same_parameter, 0.5) : tolerances::beside_end,
         low = 0;
  while (!is_past(high)) {
    if (high >= 0.5) return std::nullopt;
    low = high;
    high = std::min(growth * high, 0.5);
  }
  for (int step = 0; step < bisections; ++step) {
    const double middle = 0.5 * (low + high);
    (is_past(middle) ? high : low) = middle;
  }
  return from + high * range;
}

std::optional<CornerOpening> open_corner(const Model& model, const FaceCorner& corner, double wanted) {
  const EdgeEnd ends[2] = {end_at_corner(corner.arriving, false), end_at_corner(corner.leaving, true)};
  CornerOpening opening;
  const Vec3 vertex = model.vertex(corner.vertex);
  for (int i = 0; i < 2; ++i) {
    const auto parameter = parameter_at(model, ends[i], wanted);
    if (!parameter) return std::nullopt;
    opening.parameters[i] = *parameter;
    opening.points[i] = model.edge_point(ends[i].edge, *parameter);
  }
  const Vec3 back = opening.points[0] - vertex, out = opening.points[1] - vertex;
  const Vec3 area = cross(out, back);
  // The normal beside the edge of half a cone lies in the plane of both its edges.
  constexpr double undecided = 0.1;
  double along = dot(area, normal_at(model, corner));
  if (std::abs(along) < undecided * norm(area)) along = dot(area, normal_between(model, corner, opening));
  if (along < 0) return std::nullopt;
  opening.width = distance(opening.points[0], opening.points[1]);
  opening.degrees = std::atan2(norm(area), dot(out, back)) * 180 / std::numbers::pi;
  return opening;
}

}  // namespace aeroloom::cad
