#include "cad/repair/crossing_faces.hpp"

#include "cad/model/evaluation/point_locator.hpp"
#include "cad/model/library_unit.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/shown_list.hpp"
#include "geometry/triangle_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// Chosen, not measured. Lengths are parts of the model's diagonal.
constexpr double coarse_deflection = 0.01, coarse_angle = 0.35;  // radians
constexpr double clear_of_edges = 1e-3;
constexpr double meets_within = 1e-9;
constexpr double least_turn = 0.05;  // sine of the angle between the surfaces
constexpr int tries_of_a_pair = 50;

/// A coarse facet with its corners in space and in the parameter plane.
struct CoarseFacet {
  FaceId face;
  Vec3 corners[3];
  Vec2 uv[3];

  /// Two corners are one, as at a pole.
  bool is_degenerate() const {
    return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
  }
  double extent() const {
    return std::max({distance(corners[0], corners[1]), distance(corners[1], corners[2]),
                     distance(corners[2], corners[0])});
  }
};

geometry::CommonCorners common_corners(const CoarseFacet& a, const CoarseFacet& b) {
  geometry::CommonCorners common;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!(a.corners[i] == b.corners[k]) || common.count == 3) continue;
      common.first[common.count] = i, common.second[common.count++] = k;
    }
  }
  return common;
}

/// The parameters of a place on a facet.
Vec2 parameters_at(const CoarseFacet& facet, Vec3 place) {
  const Vec3 a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0],
             p = place - facet.corners[0];
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), det = aa * bb - ab * ab;
  if (!(det > 0)) return facet.uv[0];
  const double s = (dot(p, a) * bb - dot(p, b) * ab) / det, t = (dot(p, b) * aa - dot(p, a) * ab) / det;
  return facet.uv[0] + s * (facet.uv[1] - facet.uv[0]) + t * (facet.uv[2] - facet.uv[0]);
}

bool holds(const CoarseFacet& facet, Vec2 uv) {
  double least = 0, most = 0;
  for (int i = 0; i < 3; ++i) {
    const double side = cross(facet.uv[(i + 1) % 3] - facet.uv[i], uv - facet.uv[i]);
    least = std::min(least, side), most = std::max(most, side);
  }
  return least >= 0 || most <= 0;
}

/// Solves a symmetric 3 x 3 system, given by columns, with Cramer's rule; zero where it is singular.
Vec3 solve(const std::array<Vec3, 3>& columns, Vec3 right) {
  const double det = dot(columns[0], cross(columns[1], columns[2]));
  if (det == 0) return {};
  return Vec3{dot(right, cross(columns[1], columns[2])), dot(columns[0], cross(right, columns[2])),
              dot(columns[0], cross(columns[1], right))} /
         det;
}

double distance_to_chord(Vec3 place, Vec3 begin, Vec3 end) {
  const Vec3 along = end - begin;
  const double length2 = dot(along, along);
  const double at = length2 > 0 ? std::clamp(dot(place - begin, along) / length2, 0.0, 1.0) : 0.0;
  return distance(place, begin + at * along);
}

class CrossingSearch {
public:
  explicit CrossingSearch(const Model& model) : _model(model), _size(model.body_bounds().diagonal()) {
    for (FaceId f = 0; f < model.face_count(); ++f) {
      if (model.is_faceted(f) || model.sheet_count(f) > 1 || model.is_far_field(f)) continue;
      const Facets facets = model.facets(f, coarse_deflection * _size, coarse_angle);
      _first_of[f] = _facets.size();
      for (const auto& t : facets.triangles) {
        CoarseFacet facet{f, {}, {}};
        for (int i = 0; i < 3; ++i) facet.corners[i] = facets.points[t[i]], facet.uv[i] = facets.uv[t[i]];
        if (!facet.is_degenerate()) _facets.push_back(facet);
      }
      _end_of[f] = _facets.size();
    }
  }

  std::vector<FaceCrossing> find() {
    std::vector<geometry::Box> boxes;
    boxes.reserve(_facets.size());
    for (const CoarseFacet& facet : _facets) {
      geometry::Box& box = boxes.emplace_back();
      for (const Vec3 corner : facet.corners) box.add(corner);
    }
    const geometry::BoxTree tree(boxes, 8);
    std::vector<FaceCrossing> found;
    for (std::size_t i = 0; i < _facets.size(); ++i) {
      geometry::for_each_overlap(tree, boxes, boxes[i], [&](std::int32_t other) {
        const auto j = static_cast<std::size_t>(other);
        if (j <= i) return;
        const CoarseFacet &a = _facets[i], &b = _facets[j];
        int& tried = _tried[{a.face, b.face}];
        if (tried == tries_of_a_pair || !geometry::meet_wrongly(a.corners, b.corners, common_corners(a, b)))
          return;
        ++tried;
        if (const std::optional<Vec3> place = confirm(a, b)) {
          found.push_back({a.face, b.face, *place});
          tried = tries_of_a_pair;
        }
      });
    }
    return found;
  }

private:
  /// Where both surfaces meet near two facets, if they cross there inside of the faces.
  std::optional<Vec3> confirm(const CoarseFacet& a, const CoarseFacet& b) const {
    const Vec3 start = geometry::place_of_meeting(a.corners, b.corners);
    const double reach = a.extent() + b.extent();
    Vec2 in_a = parameters_at(a, start), in_b = parameters_at(b, start);
    constexpr int steps = 20;
    for (int step = 0; step < steps; ++step) {
      const SurfaceFrame at_a = _model.face_frame(a.face, in_a), at_b = _model.face_frame(b.face, in_b);
      if (!(distance(at_a.point, start) <= reach) || !(distance(at_b.point, start) <= reach))
        return std::nullopt;
      if (distance(at_a.point, at_b.point) <= meets_within * _size)
        return crosses(a.face, in_a, at_a, b.face, in_b, at_b) ? std::optional(at_a.point) : std::nullopt;
      approach(at_a, at_b, in_a, in_b);
    }
    return std::nullopt;
  }

  /// The shortest step, in lengths along both surfaces, that makes them meet in first order.
  static void approach(const SurfaceFrame& a, const SurfaceFrame& b, Vec2& in_a, Vec2& in_b) {
    const Vec3 derivatives[4] = {a.du, a.dv, -b.du, -b.dv};
    double lengths[4];
    std::array<Vec3, 3> columns{};
    for (int k = 0; k < 4; ++k) {
      lengths[k] = norm(derivatives[k]);
      if (!(lengths[k] > 0)) return;
      const Vec3 unit = derivatives[k] / lengths[k];
      for (int c = 0; c < 3; ++c) columns[static_cast<std::size_t>(c)] += unit[c] * unit;
    }
    const Vec3 pull = solve(columns, b.point - a.point);
    double moves[4];
    for (int k = 0; k < 4; ++k) moves[k] = dot(derivatives[k], pull) / (lengths[k] * lengths[k]);
    in_a += Vec2{moves[0], moves[1]}, in_b += Vec2{moves[2], moves[3]};
  }

  bool crosses(FaceId a, Vec2 in_a, const SurfaceFrame& at_a, FaceId b, Vec2 in_b,
               const SurfaceFrame& at_b) const {
    if (norm(cross(at_a.normal, at_b.normal)) < least_turn) return false;
    if (a == b && norm(across(a, in_a, in_b, at_a)) < clear_of_edges * _size) return false;
    return is_inside(a, in_a) && is_inside(b, in_b) && is_clear(a, at_a.point) && is_clear(b, at_a.point);
  }

  /// How far two places of a face are apart along it, in first order.
  Vec3 across(FaceId face, Vec2 from, Vec2 to, const SurfaceFrame& at) const {
    const Vec2 periods = _model.parameter_periods(face, from);
    Vec2 step = to - from;
    if (periods.x > 0) step.x = std::remainder(step.x, periods.x);
    if (periods.y > 0) step.y = std::remainder(step.y, periods.y);
    return step.x * at.du + step.y * at.dv;
  }

  /// As far as coarse facets tell.
  bool is_inside(FaceId face, Vec2 uv) const {
    const auto first = _facets.begin() + static_cast<std::ptrdiff_t>(_first_of.at(face)),
               end = _facets.begin() + static_cast<std::ptrdiff_t>(_end_of.at(face));
    return std::any_of(first, end, [&](const CoarseFacet& facet) { return holds(facet, uv); });
  }

  /// Whether a place is away from all edges of a face.
  bool is_clear(FaceId face, Vec3 place) const {
    const double clear = std::max(clear_of_edges * _size, 2 * _model.sewn_gap());
    for (const auto& loop : _model.face(face).loops) {
      for (const Coedge& use : loop) {
        if (_model.edge(use.edge).degenerate || _model.is_seam(use.edge)) continue;
        if (distance_to_edge(use.edge, place) < clear) return false;
      }
    }
    return true;
  }

  /// From chords, and from the curve around the nearest one.
  double distance_to_edge(EdgeId edge, Vec3 place) const {
    constexpr std::size_t chords = 48;
    const std::vector<double> breaks = _model.edge_breaks(edge);
    const std::size_t parts = std::max<std::size_t>(4, chords / std::max<std::size_t>(1, breaks.size()));
    double guess = breaks.front(), nearest = std::numeric_limits<double>::infinity();
    Vec3 begin = _model.edge_point(edge, guess);
    for (std::size_t span = 0; span + 1 < breaks.size(); ++span) {
      for (std::size_t part = 1; part <= parts; ++part) {
        const double along = static_cast<double>(part) / static_cast<double>(parts);
        const double at = breaks[span] + along * (breaks[span + 1] - breaks[span]);
        const Vec3 end = _model.edge_point(edge, at);
        const double away = distance_to_chord(place, begin, end);
        if (away < nearest) nearest = away, guess = at;
        begin = end;
      }
    }
    return std::min(nearest, foot_on_edge(_model, edge, place, guess).away);
  }

  const Model& _model;
  double _size;
  std::vector<CoarseFacet> _facets;  // face by face
  std::map<FaceId, std::size_t> _first_of, _end_of;
  std::map<std::pair<FaceId, FaceId>, int> _tried;
};

}  // namespace

std::vector<FaceCrossing> find_face_crossings(const Model& model) {
  return CrossingSearch(model).find();
}

void refuse_face_crossings(const Model& model) {
  const std::vector<FaceCrossing> crossings = find_face_crossings(model);
  if (crossings.empty()) return;
  const std::string text = geometry::shown_list(crossings, [&](const FaceCrossing& crossing) {
    const auto& [first, second, place] = crossing;
    const std::string faces =
        first == second ? fmt::format("face '{}' itself", model.face(first).name)
                        : fmt::format("faces '{}' and '{}'", model.face(first).name, model.face(second).name);
    return fmt::format("{} near {}", faces, place_in_file(place));
  });
  throw CadError(fmt::format(
      "walls pass through each other, as sections do that fold, so that they enclose no clear "
      "volume: {}. Remedy: draw the sections anew in the CAD program, with turns wider than their "
      "breadth, or cut off what lies beyond the crossing",
      text));
}

}  // namespace aeroloom::cad
