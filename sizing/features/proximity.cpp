#include "sizing/features/proximity.hpp"

#include "parallel/observation/progress.hpp"
#include "sizing/features/segment_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace aeroloom::sizing {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// The largest cosine between normals of walls that face each other: within 60 degrees of opposite. Chosen,
/// not measured.
constexpr double facing = -0.5;
/// The edge of facets that one ray stands for, over the size there. Chosen, not measured.
constexpr double edge_per_size = 4;
/// The distance to the common edge over the gap, below which walls are a wedge: they meet at more than 7
/// degrees. Chosen, not measured.
constexpr double wedge_slenderness = 8;
/// Halvings of a facet; chosen, not measured.
constexpr int deepest_edge_split = 24;
/// Rays that can be counted: more than any field has.
constexpr double most_counted = 1e15;
// ModelFacets that meet in an edge run together where the gap, at their angle, closes within so many times
// the way to it.
constexpr double closing_reach = 2;
// The middle of a facet's parameters is no point beside it where it is farther away, over the longest edge.
constexpr double middle_off_facet = 0.25;
// An open gap between facets over what those may be off by, at least: the distance of both from their
// surfaces and the accuracy of the model, what was sewn or this part of the widest gap. One between surfaces
// over the accuracy, and over what facets are off by: where that is far more they are no guide to what is
// opposite.
constexpr double gap_over_error = 2, accuracy = 1e-5, surface_gap_over_error = 0.25;
// A projection on a surface takes as long as visiting so many nodes of a tree.
constexpr std::int64_t nodes_per_projection = 100;
// Parts that are so many times as long as gaps ask for were hardly looked at. Chosen, not measured.
constexpr double coarse_look = 8;
constexpr std::int64_t looks_per_beat = 4096;  // between signs of life; chosen, not measured
constexpr double endless = std::numeric_limits<double>::infinity();

Vec3 unit_normal(const Triangle& t) {
  return normalized(cross(t[1] - t[0], t[2] - t[0]));
}

/// How long the parts of facets may be that see a gap.
double edge_per_gap(double layers) {
  return edge_per_size / std::max(1.0, layers);
}

/// How many times as long as the gap asks for a part is.
double coarseness(const Gaps::Part& part, double edge_per_gap) {
  return longest_edge(part.triangle).length / (edge_per_gap * part.gap);
}

}  // namespace

/// The rays of one face.
class FaceGapSearch::Rays {
public:
  Rays(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, const ModelFacets& all,
       const GapLimits& limits)
      : _model(model),
        _face(face),
        _facets(facets),
        _all(all),
        _widest(limits.widest),
        _finest(limits.finest),
        _edge_per_gap(edge_per_gap(limits.layers)),
        _thin_by_width(limits.thin_by_width),
        _accuracy(std::max(model.sewn_gap(), accuracy * limits.widest)),
        _meshed_beyond(model.face(face).back != cad::no_entity),
        _deviations(facet_deviations(model, face, facets)),
        _curvatures(facet_curvatures(model, face, facets)) {
    std::map<cad::FaceId, std::vector<SegmentTree::Segment>> shared;
    for (const cad::Facets::BoundaryLine& line : facets.boundary) {
      for (const cad::FaceId user : model.edge(line.use.edge).faces) {
        for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i)
          shared[user].push_back({facets.points[line.nodes[i]], facets.points[line.nodes[i + 1]], user});
      }
    }
    for (auto& [user, segments] : shared) _edges.emplace(user, std::move(segments));
  }

  std::int64_t cover(std::int64_t most, Gaps& gaps) {
    _gaps = std::move(gaps);
    const std::int64_t before = _nodes;
    const std::vector<Gaps::Unseen> parts = _begun ? std::exchange(_gaps.unseen, {}) : whole_facets();
    _begun = true;
    double left = 0;
    for (const Gaps::Unseen& part : parts) left += area_of(part.triangle);
    for (const Gaps::Unseen& part : parts) {
      const double own = area_of(part.triangle), rest = static_cast<double>(most - (_nodes - before));
      cover(part, std::llround(left > own ? std::ceil(rest * own / left) : rest));
      left -= own;
    }
    gaps = std::move(_gaps);
    return _nodes - before;
  }

  LookedAt look_closer(double apart, const LookedAt& most, Gaps& gaps) {
    std::vector<Narrow> heap;
    _gaps = std::move(gaps);
    std::int64_t pushed = 0;
    const auto push = [&](const Gaps::Part& part) {
      heap.push_back({part, coarseness(part, _edge_per_gap), pushed++});
      std::push_heap(heap.begin(), heap.end());
    };
    for (const Gaps::Part& part : std::exchange(_gaps.narrow, {})) push(part);
    const std::int64_t before = _nodes;
    std::int64_t rays = 0;
    while (!heap.empty() && heap.front().coarseness > apart && rays < most.rays &&
           _nodes - before < most.nodes) {
      std::pop_heap(heap.begin(), heap.end());
      const Gaps::Part part = heap.back().part;
      heap.pop_back();
      for (const Triangle& half : bisect(part.triangle, longest_edge(part.triangle).from)) {
        const std::optional<Gaps::Part> narrow = look_at({half, part.gap, part.facet, part.depth + 1});
        if (narrow) push(*narrow);
        ++rays;
      }
    }
    for (const Narrow& left : heap) _gaps.narrow.push_back(left.part);
    gaps = std::move(_gaps);
    return {rays, _nodes - before};
  }

private:
  /// The part that is looked at next: the longest for its gap, the first one of several.
  struct Narrow {
    Gaps::Part part;
    double coarseness;
    std::int64_t number;
    bool operator<(const Narrow& other) const {
      return coarseness != other.coarseness ? coarseness < other.coarseness : number > other.number;
    }
  };

  struct Seen {
    double gap = endless, open = endless;
  };

  /// On both sides together; `thin`: of a side that is not meshed, whose faces bend so much.
  struct Around {
    double gap = endless, open = endless, thin = endless, bend = 0;
  };

  std::vector<Gaps::Unseen> whole_facets() const {
    std::vector<Gaps::Unseen> parts;
    parts.reserve(_facets.triangles.size());
    for (std::size_t f = 0; f < _facets.triangles.size(); ++f) {
      const auto& [a, b, c] = _facets.triangles[f];
      parts.push_back(
          {{_facets.points[a], _facets.points[b], _facets.points[c]}, static_cast<std::int32_t>(f), 0});
    }
    return parts;
  }

  /// With about so many nodes; the halves of a part get the same.
  void cover(const Gaps::Unseen& part, std::int64_t most) {
    const Triangle& t = part.triangle;
    const Vec3 center = (t[0] + t[1] + t[2]) / 3;
    const Vec3 normal = unit_normal(t);
    if (!(norm(normal) > 0.5)) return;
    if (most <= 0) {
      _gaps.unseen.push_back(part);
      return;
    }
    const std::int64_t before = _nodes;
    const auto [gap, open, thin, bend] = look_around(center, normal, part.facet);
    if (gap <= _widest) _gaps.seen.push_back({center, gap});
    if (thin <= _widest) _gaps.seen.push_back({center, thin, false, bend});
    if (open <= _widest) _gaps.open.push_back({center, open});
    const auto [from, length] = longest_edge(t);
    // Without a gap in sight the facet is searched as closely as gaps of the widest kind would need.
    const double asked = _thin_by_width || thin > _widest ? thin : size_that_keeps_apart(thin, bend);
    const double fine = std::max(_finest, _edge_per_gap * std::min({gap, asked, _widest}));
    if (length > fine && part.depth < deepest_edge_split) {
      const auto halves = bisect(t, from);
      cover({halves[0], part.facet, part.depth + 1}, (most - (_nodes - before)) / 2);
      cover({halves[1], part.facet, part.depth + 1}, most - (_nodes - before));
    } else if (length > _edge_per_gap * open) {
      _gaps.narrow.push_back({t, open, part.facet, 0});
    }
  }

  /// `part.gap`: of the last larger part that saw one. The part with its own, where that is to be looked at
  /// still closer.
  std::optional<Gaps::Part> look_at(Gaps::Part part) {
    const Triangle& t = part.triangle;
    const Vec3 center = (t[0] + t[1] + t[2]) / 3;
    const Vec3 normal = unit_normal(t);
    if (!(norm(normal) > 0.5)) return std::nullopt;
    const double open = look_around(center, normal, part.facet).open;
    if (open <= _widest) _gaps.open.push_back({center, open}), part.gap = open;
    if (coarseness(part, _edge_per_gap) <= 1 || part.depth >= deepest_edge_split) return std::nullopt;
    return part;
  }

  /// Distances along the normal, to either side, to the nearest wall that faces back, the lower one where two
  /// are as near; infinity where there is none in reach. `facet`: that looked from.
  Around look_around(Vec3 from, Vec3 normal, std::int32_t facet) {
    if (++_looks % looks_per_beat == 0) parallel::beat();
    const auto faces_back = [&](std::int32_t triangle) {
      return dot(_all.normals[triangle], normal) <= facing;
    };
    const auto corners = [&](std::int32_t triangle) -> const Triangle& {
      return _all.items[triangle].corners;
    };
    const auto nearest = _all.rays.nearest_crossings(from, normal, _widest, corners, faces_back, _nodes);
    const Seen ahead = judge(nearest[0], from, normal, facet, _meshed_beyond);
    const Seen behind = judge(nearest[1], from, -normal, facet, true);
    Around around{behind.gap, std::min(ahead.open, behind.open)};
    double& out_of_face = _meshed_beyond ? around.gap : around.thin;
    out_of_face = std::min(out_of_face, ahead.gap);
    if (around.thin < endless) around.bend = _curvatures[facet] + _all.items[nearest[0].triangle].curvature;
    return around;
  }

  /// Whether a crossing is a gap, on a side that is meshed or not. The direction is that of the ray.
  Seen judge(const RayTree::Crossing& crossing, Vec3 from, Vec3 direction, std::int32_t facet, bool meshed) {
    if (crossing.triangle < 0) return {};
    const ModelFacet& opposite = _all.items[crossing.triangle];
    double away = crossing.distance;
    if (is_edge_within(wedge_slenderness * away, from, opposite.face)) return {};
    const Seen closed{away, endless};
    if (!meshed) return closed;
    const double off = _deviations[facet] + opposite.deviation;
    if (away < gap_over_error * (off + _accuracy)) {
      if (off <= 0 || is_edge_within(longest_facet(facet, opposite), from, opposite.face)) return closed;
      away = distance_of_surfaces(from, direction, away, facet, opposite);
      if (away < std::max(gap_over_error * _accuracy, surface_gap_over_error * off)) return closed;
    }
    const double turn = norm(cross(_all.normals[crossing.triangle], direction));
    const bool closes =
        turn > 0 && is_edge_within(endless, from, opposite.face, away / (closing_reach * turn));
    return {closed.gap, closes ? endless : away};
  }

  /// ModelFacets that run together towards a common edge, bent as their facets are, are nearer to each other
  /// than those are off so far from it. What is found there is no gap but a cusp, or a fold of surfaces that
  /// cross beside the edge.
  double longest_facet(std::int32_t facet, const ModelFacet& opposite) const {
    const auto& [a, b, c] = _facets.triangles[facet];
    const Triangle own{_facets.points[a], _facets.points[b], _facets.points[c]};
    return std::max(longest_edge(own).length, longest_edge(opposite.corners).length);
  }

  /// How far the opposite surface is from that of the face, beside the point on its facet; nothing where they
  /// cross, or where that is not known.
  double distance_of_surfaces(Vec3 from, Vec3 direction, double away, std::int32_t facet,
                              const ModelFacet& opposite) {
    if (_model.sheet_count(_face) > 1 || _model.sheet_count(opposite.face) > 1) return 0;
    _nodes += nodes_per_projection;
    const auto& [a, b, c] = _facets.triangles[facet];
    const Vec2 own = parameters_at({_facets.points[a], _facets.points[b], _facets.points[c]},
                                   {_facets.uv[a], _facets.uv[b], _facets.uv[c]}, from);
    const Vec3 point = _model.face_point(_face, own);
    const cad::Projection foot = _model.project(
        opposite.face, point, parameters_at(opposite.corners, opposite.parameters, from + away * direction));
    if (!foot.converged) return 0;
    const double apart = distance(point, foot.point);
    return dot(foot.point - point, direction) >= -facing * apart ? apart : 0;
  }

  /// Whether the face meets the opposite one (or itself) in an edge so near, but not nearer than `least`.
  bool is_edge_within(double reach, Vec3 point, cad::FaceId opposite, double least = 0) {
    const auto edges = _edges.find(opposite);
    if (edges == _edges.end()) return false;
    const double away = edges->second.nearest(point, reach, &_nodes);
    return away < reach && away >= least;
  }

  const cad::Model& _model;
  cad::FaceId _face;
  const cad::Facets& _facets;
  const ModelFacets& _all;
  std::map<cad::FaceId, SegmentTree>
      _edges;  // that the face shares with each neighbour; all of them with itself
  double _widest, _finest, _edge_per_gap;
  bool _thin_by_width;
  double _accuracy;
  bool _meshed_beyond;
  std::vector<double> _deviations, _curvatures;  // of the facets
  bool _begun = false;
  std::int64_t _nodes = 0, _looks = 0;  // visited so far, and rays
  Gaps _gaps;
};

std::vector<double> facet_deviations(const cad::Model& model, cad::FaceId face, const cad::Facets& facets) {
  std::vector<double> deviations;
  deviations.reserve(facets.triangles.size());
  for (const auto& [a, b, c] : facets.triangles) {
    double deviation = 0;
    if (!model.is_planar(face) && !model.is_faceted(face)) {
      const geometry::Vec2 middle = (facets.uv[a] + facets.uv[b] + facets.uv[c]) / 3;
      const Triangle corners{facets.points[a], facets.points[b], facets.points[c]};
      deviation =
          std::min(distance(model.face_point(face, middle), (corners[0] + corners[1] + corners[2]) / 3),
                   middle_off_facet * longest_edge(corners).length);
    }
    deviations.push_back(deviation);
  }
  return deviations;
}

std::vector<double> facet_curvatures(const cad::Model& model, cad::FaceId face, const cad::Facets& facets) {
  std::vector<double> of_points(facets.points.size(), 0);
  if (!model.is_planar(face)) {
    for (std::size_t p = 0; p < of_points.size(); ++p) {
      const cad::PrincipalCurvatures seen = model.face_curvatures(face, facets.uv[p]);
      if (seen.defined) of_points[p] = std::abs(seen.largest);
    }
  }
  std::vector<double> curvatures;
  curvatures.reserve(facets.triangles.size());
  for (const auto& [a, b, c] : facets.triangles)
    curvatures.push_back(std::max({of_points[a], of_points[b], of_points[c]}));
  return curvatures;
}

double size_that_keeps_apart(double width, double bend) {
  // Both sides leave their surfaces by half the width together: h^2 / 3, the square of the radius around a
  // triangle, times half the curvature.
  return bend > 0 ? std::sqrt(3 * width / bend) : endless;
}

namespace {

std::vector<Triangle> corners_of(const std::vector<ModelFacet>& facets) {
  std::vector<Triangle> corners;
  corners.reserve(facets.size());
  for (const ModelFacet& facet : facets) corners.push_back(facet.corners);
  return corners;
}

}  // namespace

ModelFacets::ModelFacets(std::vector<ModelFacet> all)
    : tree(corners_of(all)), rays(corners_of(all)), items(std::move(all)) {
  normals.reserve(items.size());
  for (const ModelFacet& facet : items) normals.push_back(unit_normal(facet.corners));
}

FaceGapSearch::FaceGapSearch(const cad::Model& model, cad::FaceId face, const cad::Facets& facets,
                             const ModelFacets& all, const GapLimits& limits)
    : _rays(std::make_shared<Rays>(model, face, facets, all, limits)) {}

std::int64_t FaceGapSearch::go_on(std::int64_t nodes, Gaps& gaps) {
  return _rays->cover(nodes, gaps);
}

LookedAt FaceGapSearch::look_closer(double apart, const LookedAt& most, Gaps& gaps) {
  return _rays->look_closer(apart, most, gaps);
}

const Gaps::Part* find_coarsest(const Gaps& gaps, double layers) {
  const Gaps::Part* coarsest = nullptr;
  double most = coarse_look;
  for (const Gaps::Part& part : gaps.narrow) {
    const double coarse = coarseness(part, edge_per_gap(layers));
    if (coarse > most) most = coarse, coarsest = &part;
  }
  return coarsest;
}

std::int64_t count_rays(const Gaps& gaps, double layers) {
  double rays = 0;
  for (const Gaps::Part& part : gaps.narrow) {
    const double edge = edge_per_gap(layers) * part.gap;
    rays += rays_per_area * area_of(part.triangle) / (edge * edge);
  }
  return std::llround(std::min(rays, most_counted));
}

}  // namespace aeroloom::sizing
