// Sharp corners of faces: the face between two edges that meet at a small angle is narrow.
#include "sizing/features/model_sources.hpp"
#include "sizing/field/closed_corners.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::sizing {
namespace {

/// Corners below this angle (degrees) have a triangle of their own; sources begin behind it. Chosen, not
/// measured.
constexpr double sharp = 30;
/// Distances from the corner at which sources are put follow each other by this ratio. Chosen, not measured.
constexpr double step = 1.15;
/// Behind this many steps (a factor of a thousand) a corner is none any more.
constexpr int most_steps = 50;

/// A part of the shorter edge, so that there is something behind the corner.
double nearest_reach(const cad::Model& model, const cad::FaceCorner& corner) {
  constexpr double part = 0.25;  // corners at both ends, and as much between them
  double shortest = std::numeric_limits<double>::max();
  for (const cad::EdgeId id : {corner.arriving.edge, corner.leaving.edge}) {
    const cad::Edge& edge = model.edge(id);
    const geometry::Vec3 middle = model.edge_point(id, 0.5 * (edge.first_parameter + edge.last_parameter));
    shortest = std::min(shortest, 2 * distance(middle, model.vertex(corner.vertex)));
  }
  return part * shortest;
}

/// Seen from three distances: edges that are tangent at the corner part farther away, others only look sharp
/// there.
bool opens_by_less(const cad::Model& model, const cad::FaceCorner& corner, double degrees) {
  const double farthest = nearest_reach(model, corner);
  for (const double part : {1.0, 0.1, 0.01}) {
    const auto opening = cad::open_corner(model, corner, part * farthest);
    if (opening && opening->degrees < degrees) return true;
  }
  return false;
}

}  // namespace

bool may_be_sharp(const cad::Model& model, const cad::FaceCorner& corner) {
  return opens_by_less(model, corner, sharp);
}

bool is_closed_corner(const cad::Model& model, const cad::FaceCorner& corner) {
  return opens_by_less(model, corner, closing_angle(model, corner));
}

std::vector<SizeSource> corner_sources(const cad::Model& model, const cad::FaceCorner& corner, double reach,
                                       const SizingOptions& options) {
  std::vector<SizeSource> sources;
  reach = std::min(reach, nearest_reach(model, corner));
  const double closed = closing_angle(model, corner);
  for (int k = 0; k < most_steps; ++k, reach *= step) {
    const auto opening = cad::open_corner(model, corner, reach);
    if (!opening || (k == 0 && opening->degrees >= sharp)) break;
    if (opening->degrees < closed && opening->width < closing_gap(options)) continue;
    const double size = feature_size(opening->width, smallest_feature_size(options), options);
    if (size >= options.maximum || opening->degrees > 2 * sharp) break;
    for (const geometry::Vec3 point : opening->points) sources.push_back({point, size});
  }
  return sources;
}

}  // namespace aeroloom::sizing
