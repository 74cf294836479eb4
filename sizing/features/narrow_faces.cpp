#include "sizing/features/narrow_faces.hpp"

#include "cad/model/evaluation/face_width.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace aeroloom::sizing {
namespace {

using cad::Coedge;
using cad::FaceId;
using cad::Model;
using cad::no_entity;
using geometry::Vec3;

/// Degrees by which a face turns into the neighbour that it is joined with, at most: a crease that turns more
/// is a feature that elements are to follow. Chosen, not measured.
constexpr double largest_turn = 20;
/// A face without normals at its border counts as turning by this much: none goes on smoothly in it.
constexpr double half_turn = 180;

/// An exact plane stays one: it joins its like alone.
bool may_join(const Model& model, FaceId a, FaceId b) {
  const cad::Face &first = model.face(a), &second = model.face(b);
  return !model.is_far_field(b) && !model.is_faceted(b) &&
         model.is_exact_plane(a) == model.is_exact_plane(b) && first.patch == second.patch &&
         first.front == second.front && first.back == second.back;
}

/// The face on the other side of an edge; no_entity where it is not used by exactly two faces, once each.
FaceId beyond(const Model& model, FaceId face, cad::EdgeId id) {
  const cad::Edge& edge = model.edge(id);
  if (edge.degenerate || edge.faces.size() != 2) return no_entity;
  return edge.faces[0] == face ? edge.faces[1] : edge.faces[0];
}

std::optional<Coedge> use_of(const Model& model, FaceId face, cad::EdgeId edge) {
  std::optional<Coedge> found;
  for (const auto& loop : model.face(face).loops) {
    for (const Coedge& use : loop) {
      if (use.edge != edge) continue;
      if (found) return std::nullopt;
      found = use;
    }
  }
  return found;
}

double deviation_of(double width, double degrees) {
  return degrees < 90 ? width * std::sin(degrees * std::numbers::pi / 180) : width;
}

/// The common border of a narrow face and one neighbour.
struct Border {
  double length = 0, degrees = 0;
  Vec3 place;
};

std::optional<NarrowFace> examine(const Model& model, FaceId face, double width, double tolerance) {
  if (model.is_far_field(face) || model.is_faceted(face)) return std::nullopt;
  NarrowFace found;
  found.face = face;
  found.width = cad::mean_width(model, face);
  if (!(found.width < width)) return std::nullopt;
  std::map<FaceId, Border> borders;
  for (const auto& loop : model.face(face).loops) {
    for (const Coedge& use : loop) {
      const FaceId other = beyond(model, face, use.edge);
      if (other == no_entity || !may_join(model, face, other)) continue;
      Border& border = borders[other];
      const cad::Edge& edge = model.edge(use.edge);
      border.length += cad::rough_length(model, use.edge);
      border.degrees = std::max(border.degrees, turn_across(model, face, other, use.edge));
      border.place = model.edge_point(use.edge, 0.5 * (edge.first_parameter + edge.last_parameter));
    }
  }
  double longest = 0;
  for (const auto& [other, border] : borders) {
    const double deviation = deviation_of(found.width, border.degrees);
    if (border.degrees > largest_turn || deviation > tolerance || border.length <= longest) continue;
    longest = border.length;
    found.into = other;
    found.degrees = border.degrees;
    found.deviation = deviation;
    found.place = border.place;
  }
  if (found.into == no_entity) return std::nullopt;
  return found;
}

}  // namespace

double turn_across(const Model& model, FaceId a, FaceId b, cad::EdgeId id) {
  constexpr int samples = 16;  // along an edge; chosen, not measured
  const auto first = use_of(model, a, id), second = use_of(model, b, id);
  if (!first || !second) return half_turn;
  const cad::Edge& edge = model.edge(id);
  double largest = 0;
  for (int i = 0; i < samples; ++i) {
    const double t =
        edge.first_parameter + (i + 0.5) / samples * (edge.last_parameter - edge.first_parameter);
    const Vec3 n = model.face_frame(a, model.edge_uv(a, *first, t)).normal;
    const Vec3 m = model.face_frame(b, model.edge_uv(b, *second, t)).normal;
    if (!(norm(n) > 0 && norm(m) > 0)) return half_turn;
    largest = std::max(largest, angle_between(n, m) * 180 / std::numbers::pi);
  }
  return largest;
}

std::vector<NarrowFace> find_narrow_faces(const parallel::Communicator& communicator, const Model& model,
                                          double width, double tolerance) {
  std::vector<NarrowFace> found;
  parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
    for (FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      if (const auto narrow = examine(model, f, width, tolerance)) found.push_back(*narrow);
    }
  });
  found = communicator.gather_sorted(found, &NarrowFace::face);
  return found;
}

std::vector<std::vector<FaceId>> group_narrow_faces(const Model& model, std::vector<NarrowFace>& narrow,
                                                    double tolerance) {
  std::vector<std::vector<FaceId>> groups(model.face_count());
  std::vector<FaceId> group_of(model.face_count());
  for (FaceId f = 0; f < model.face_count(); ++f) groups[f] = {f}, group_of[f] = f;
  std::vector<NarrowFace> kept;
  for (const NarrowFace& each : narrow) {
    const FaceId from = group_of[each.face], to = group_of[each.into];
    if (from == to) continue;
    // No crease may vanish between any two members.
    bool smooth = true;
    for (const FaceId a : groups[from]) {
      for (const auto& loop : model.face(a).loops) {
        for (const Coedge& use : loop) {
          const FaceId b = beyond(model, a, use.edge);
          if (b == no_entity || group_of[b] != to) continue;
          const double turn = turn_across(model, a, b, use.edge);
          smooth = smooth && turn <= largest_turn && deviation_of(each.width, turn) <= tolerance;
        }
      }
    }
    if (!smooth) continue;
    for (const FaceId f : groups[from]) group_of[f] = to;
    groups[to].insert(groups[to].end(), groups[from].begin(), groups[from].end());
    groups[from].clear();
    kept.push_back(each);
  }
  narrow = std::move(kept);
  std::erase_if(groups, [](const std::vector<FaceId>& group) { return group.size() < 2; });
  return groups;
}

}  // namespace aeroloom::sizing
