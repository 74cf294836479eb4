#include "sizing/features/trailing_candidates.hpp"

#include "geometry/angle.hpp"
#include "sizing/features/segment_tree.hpp"

#include <algorithm>
#include <numbers>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// Between the way into the body and that against the flow, at most: a trailing edge may be swept so far.
constexpr double least_cosine = 0.5;
/// Of the body behind a sharp edge; sections end at some twenty degrees, coves at forty.
constexpr double largest_opening = std::numbers::pi / 3;
/// Of each edge of the CAD. Chosen, not measured.
constexpr int intervals = 128;

void add_points(const cad::Model& model, cad::EdgeId id, bool against, std::vector<Vec3>& points) {
  const cad::Edge& edge = model.edge(id);
  for (int i = points.empty() ? 0 : 1; i <= intervals; ++i) {
    const double fraction = static_cast<double>(against ? intervals - i : i) / intervals;
    points.push_back(
        model.edge_point(id, edge.first_parameter + fraction * (edge.last_parameter - edge.first_parameter)));
  }
}

std::vector<Vec3> border_points(const cad::Model& model, const std::vector<cad::BorderEdge>& border) {
  std::vector<Vec3> points;
  for (const cad::BorderEdge& each : border) add_points(model, each.strip_use.edge, each.against, points);
  return points;
}

Vec3 nearest_point(const std::vector<Vec3>& line, Vec3 p) {
  Vec3 best = line.front();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 q = line[i] + part_along(p, line[i], line[i + 1]) * (line[i + 1] - line[i]);
    if (distance(p, q) < distance(p, best)) best = q;
  }
  return best;
}

/// A face's pass along an edge.
struct Pass {
  cad::FaceId face;
  cad::Coedge use;
};

std::vector<Pass> passes_of(const cad::Model& model, cad::EdgeId edge) {
  std::vector<Pass> passes;
  for (const cad::FaceId face : model.edge(edge).faces) {
    for (const auto& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop)
        if (use.edge == edge) passes.push_back({face, use});
    }
  }
  return passes;
}

/// Whether the body between two passes is a wedge that opens against the flow, at a parameter of the edge.
bool opens_ahead(const cad::Model& model, const std::vector<Pass>& passes, double parameter, Vec3 flow) {
  Vec3 into[2], normal[2];
  for (int side = 0; side < 2; ++side) {
    const auto& [face, use] = passes[side];
    // Out of the fluid, into the body.
    normal[side] = model.face_frame(face, model.edge_uv(face, use, parameter)).normal;
    const Vec3 along = (use.reversed ? -1.0 : 1.0) * model.edge_tangent(use.edge, parameter);
    into[side] = normalized(cross(normal[side], along));
  }
  const bool is_convex = dot(into[0], normal[1]) > 0 && dot(into[1], normal[0]) > 0;
  const double opening = angle_between(into[0], into[1]);
  return is_convex && opening < largest_opening && -dot(normalized(into[0] + into[1]), flow) > least_cosine;
}

}  // namespace

std::optional<TrailingCandidate> blunt_candidate(const cad::Model& model, cad::FaceId face, Vec3 flow) {
  using Kind = cad::BluntEdgeFinding::Kind;
  const cad::BluntEdgeFinding found = cad::examine_blunt_edge(model, face, 0);
  if (found.kind != Kind::closable && found.kind != Kind::wide) return std::nullopt;
  const cad::BluntEdge& strip = found.edge;
  const auto looks_back = [&](const cad::BluntStation& at) { return -dot(at.into, flow) > least_cosine; };
  if (!std::all_of(strip.stations.begin(), strip.stations.end(), looks_back)) return std::nullopt;
  TrailingCandidate candidate;
  candidate.element.blunt_face = face;
  const std::vector<Vec3> other = border_points(model, strip.borders[1]);
  candidate.element.trailing.points = border_points(model, strip.borders[0]);
  for (const Vec3 p : candidate.element.trailing.points)
    candidate.element.opposite.push_back(nearest_point(other, p));
  for (const auto& border : strip.borders) {
    for (const cad::BorderEdge& each : border) candidate.neighbours.push_back(each.neighbour);
    const auto vertex = [&](const cad::BorderEdge& each, bool at_first) {
      const cad::Edge& edge = model.edge(each.strip_use.edge);
      return at_first != each.against ? edge.first : edge.last;
    };
    candidate.element.end_vertices[0].insert(vertex(border.front(), true));
    candidate.element.end_vertices[1].insert(vertex(border.back(), false));
  }
  return candidate;
}

std::optional<TrailingCandidate> sharp_candidate(const cad::Model& model, cad::EdgeId id, Vec3 flow) {
  const cad::Edge& edge = model.edge(id);
  if (edge.degenerate) return std::nullopt;
  const std::vector<Pass> passes = passes_of(model, id);
  if (passes.size() != 2) return std::nullopt;
  for (const Pass& pass : passes)
    if (model.is_far_field(pass.face) || model.face(pass.face).back != cad::no_entity) return std::nullopt;
  for (const double fraction : {0.2, 0.5, 0.8}) {
    const double at = edge.first_parameter + fraction * (edge.last_parameter - edge.first_parameter);
    if (!opens_ahead(model, passes, at, flow)) return std::nullopt;
  }
  TrailingCandidate candidate;
  candidate.element.edge = id;
  add_points(model, id, false, candidate.element.trailing.points);
  for (const Pass& pass : passes) candidate.neighbours.push_back(pass.face);
  candidate.element.end_vertices[0].insert(edge.first);
  candidate.element.end_vertices[1].insert(edge.last);
  return candidate;
}

}  // namespace aeroloom::sizing
