#include "sizing/features/skin_faces.hpp"

#include "sizing/features/narrow_faces.hpp"

#include <vector>

namespace aeroloom::sizing {
namespace {

/// Whether the body lies on both sides of the planes of two faces, half-way along an edge between them.
bool is_valley(const cad::Model& model, cad::FaceId face, cad::FaceId other, const cad::Coedge& use) {
  const cad::Edge& edge = model.edge(use.edge);
  const double at = 0.5 * (edge.first_parameter + edge.last_parameter);
  const geometry::Vec3 normal = model.face_frame(face, model.edge_uv(face, use, at)).normal;
  const geometry::Vec3 into = cross(
      normal, (use.reversed ? -1.0 : 1.0) * model.edge_tangent(use.edge, at));  // the face, from the edge
  for (const auto& loop : model.face(other).loops) {
    for (const cad::Coedge& pass : loop) {
      // Normals point into the body.
      if (pass.edge == use.edge)
        return dot(into, model.face_frame(other, model.edge_uv(other, pass, at)).normal) < 0;
    }
  }
  return false;
}

}  // namespace

std::set<cad::FaceId> skin_faces(const cad::Model& model, std::span<const cad::FaceId> first,
                                 cad::FaceId except, Kinks kinks) {
  // Degrees: a skin goes on beyond an edge that turns by less, but for tips and noses
  // (docs/cad_repair.md).
  constexpr double largest_kink = 50;
  // Degrees: planform kinks and patches that fit badly turn by less. Chosen, not measured.
  constexpr double deepest_valley = 15;
  // A skin of more faces is cut off. Chosen, not measured.
  constexpr std::size_t most_faces_of_skin = 64;
  std::set<cad::FaceId> skin;
  std::vector<cad::FaceId> next;
  const auto add = [&](cad::FaceId face) {
    if (face != except && !model.is_far_field(face) && skin.size() < most_faces_of_skin &&
        skin.insert(face).second)
      next.push_back(face);
  };
  for (const cad::FaceId face : first) add(face);
  for (std::size_t i = 0; i < next.size(); ++i) {
    const cad::FaceId face = next[i];
    for (const auto& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop) {
        const cad::Edge& edge = model.edge(use.edge);
        if (edge.degenerate || edge.faces.size() != 2 || edge.faces[0] == edge.faces[1]) continue;
        const cad::FaceId other = edge.faces[0] == face ? edge.faces[1] : edge.faces[0];
        if (skin.contains(other)) continue;
        const double turn = turn_across(model, face, other, use.edge);
        if (turn > largest_kink) continue;
        if (kinks == Kinks::no_valleys && turn > deepest_valley && is_valley(model, face, other, use))
          continue;
        add(other);
      }
    }
  }
  return skin;
}

}  // namespace aeroloom::sizing
