#include "surface/corner_legs.hpp"

#include "geometry/face_corners.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace aeroloom::surface {
namespace {

using geometry::EdgeEnd;
using geometry::FaceCorner;
using geometry::Model;
using geometry::Vec3;

constexpr double sharp = 30;  // degrees
/// A leg ends where the gap between the edges is this part of the size there.
constexpr double fitting = 0.8;
/// Legs are sought in steps of this ratio, from the size at the corner on.
constexpr double step = 1.1;
constexpr int most_steps = 36;
/// An edge turns less than this along a leg (degrees).
constexpr double straight = 10;

/// Whether the edge stays close to its chord up to the parameter.
bool is_straight(const Model& model, EdgeEnd end, double parameter, Vec3 point) {
  const geometry::Edge& edge = model.edge(end.edge);
  const double from = end.first ? edge.first_parameter : edge.last_parameter;
  const Vec3 chord = point - model.edge_point(end.edge, from);
  const double cosine = std::cos(straight * std::numbers::pi / 180);
  for (const double t : {from, parameter}) {
    const Vec3 tangent = model.edge_tangent(end.edge, t);
    if (std::abs(dot(tangent, chord)) < cosine * norm(tangent) * norm(chord)) return false;
  }
  return true;
}

/// The leg of one corner, 0 when it is not sharp or no leg fits.
double leg_of(const Model& model, const sizing::SizeField& field, const FaceCorner& corner) {
  const EdgeEnd ends[2] = {end_at_corner(corner.arriving, false), end_at_corner(corner.leaving, true)};
  double reach = field(model.vertex(corner.vertex));
  for (int k = 0; k < most_steps; ++k, reach *= step) {
    const auto opening = geometry::open_corner(model, corner, reach);
    if (!opening || opening->degrees >= sharp) return 0;
    for (int i = 0; i < 2; ++i) {
      if (!is_straight(model, ends[i], opening->parameters[i], opening->points[i])) return 0;
    }
    const double size = std::min(field(opening->points[0]), field(opening->points[1]));
    if (opening->width >= fitting * size) return reach;
  }
  return 0;
}

struct Leg {
  geometry::VertexId vertex;
  std::array<EdgeEnd, 2> ends;
  double length;
};

}  // namespace

std::vector<std::array<double, 2>> corner_legs(const parallel::Communicator& communicator, const Model& model,
                                               const sizing::SizeField& field, parallel::StageClock& clock) {
  std::vector<Leg> legs;
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::task);
    for (geometry::FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      for (const FaceCorner& corner : geometry::corners_of(model, f)) {
        const double length = leg_of(model, field, corner);
        if (!(length > 0)) continue;
        legs.push_back({corner.vertex,
                        {end_at_corner(corner.arriving, false), end_at_corner(corner.leaving, true)},
                        length});
      }
    }
  });
  legs = communicator.all_gather_items<Leg>(legs);
  // Corners at one vertex may share an edge: they take the longest leg together.
  std::vector<double> longest(model.vertex_count(), 0);
  for (const Leg& leg : legs) longest[leg.vertex] = std::max(longest[leg.vertex], leg.length);
  std::vector<std::array<double, 2>> result(model.edge_count(), {0, 0});
  for (const Leg& leg : legs) {
    for (const EdgeEnd& end : leg.ends) result[end.edge][end.first ? 0 : 1] = longest[leg.vertex];
  }
  return result;
}

}  // namespace aeroloom::surface
