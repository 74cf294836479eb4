#include "sizing/choice/coincident_faces.hpp"

#include "geometry/sort_unique.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/features/facet_parameters.hpp"
#include "sizing/features/segment_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using geometry::Vec2;
using geometry::Vec3;
using parallel::ScopedCpu;

// Faces are on one another where they are nearer than this, of the body's extent, over this part of the
// smaller one's area.
constexpr double nearest_walls = 2e-5, least_part = 0.05;
// Faces with a meshed gap between them are on one another up to so much of the extent, if elements as small
// as the gap would be more triangles on each of the two than any mesh can spare for one gap. A body as thin
// as that is only thin.
constexpr double nearest_in_gap = 2e-4, most_triangles_in_gap = 1e7;
constexpr double triangles_per_area = 4 / std::numbers::sqrt3;  // times the square of their edges
// What is no wider than `nearest_walls` is noise, as what is no farther apart: a strip along the end of a
// sharp trailing edge, or along a common edge. ModelFacets that run together towards a common edge are no
// overlap: the distance over that to the edge, at most.
constexpr double least_wedge = 1e-3;
// Chosen, not measured: the cosine between normals, to either side; the overlap of two facets over the area
// of the smaller one; places of two faces, those of the largest overlaps, each of which takes a projection.
constexpr double least_cosine = 0.9, least_overlap = 1e-3;
constexpr std::size_t places_looked_at = 16;
// Nodes of the tree that the search may visit: in all, distributed by facets, and for each face.
constexpr double most_tree_nodes = 1e8;
constexpr std::int64_t few_tree_nodes = 1000;

/// A convex polygon in space, at most six corners of two triangles that overlap, and some for rounding.
struct Polygon {
  std::array<Vec3, 9> corners;
  int count = 0;

  void add(Vec3 p) {
    if (count < static_cast<int>(corners.size())) corners[count++] = p;
  }
};

/// The part of the polygon to the left of the line from a to b, seen against the normal.
Polygon clip(const Polygon& polygon, Vec3 a, Vec3 b, Vec3 normal) {
  const Vec3 inward = cross(normal, b - a);
  Polygon inside;
  for (int i = 0; i < polygon.count; ++i) {
    const Vec3 p = polygon.corners[i], q = polygon.corners[(i + 1) % polygon.count];
    const double at_p = dot(p - a, inward), at_q = dot(q - a, inward);
    if (at_p >= 0) inside.add(p);
    if ((at_p < 0) != (at_q < 0)) inside.add(p + at_p / (at_p - at_q) * (q - p));
  }
  return inside;
}

struct Overlap {
  double area = 0;
  Vec3 middle;  // in the plane of the first
  geometry::Box box;
};

/// Of two triangles, seen along the normal of the first.
Overlap overlap_of(const Triangle& first, Vec3 normal, const Triangle& second) {
  Polygon polygon;
  for (const Vec3 p : second) polygon.add(p - dot(p - first[0], normal) * normal);
  for (int i = 0; i < 3 && polygon.count > 2; ++i)
    polygon = clip(polygon, first[i], first[(i + 1) % 3], normal);
  Overlap overlap;
  Vec3 moment;
  for (int i = 1; i + 1 < polygon.count; ++i) {
    const Vec3 &a = polygon.corners[0], &b = polygon.corners[i], &c = polygon.corners[i + 1];
    const double area = 0.5 * std::abs(dot(cross(b - a, c - a), normal));
    overlap.area += area;
    moment = moment + area / 3 * (a + b + c);
  }
  if (overlap.area > 0) overlap.middle = moment / overlap.area;
  for (int i = 0; i < polygon.count; ++i) overlap.box.add(polygon.corners[i]);
  return overlap;
}

/// The parameters of a point in the plane of a facet, or beside it along its normal.
Vec2 parameters_at(const cad::Facets& facets, std::int32_t facet, Vec3 point) {
  const auto& [a, b, c] = facets.triangles[facet];
  return sizing::parameters_at({facets.points[a], facets.points[b], facets.points[c]},
                               {facets.uv[a], facets.uv[b], facets.uv[c]}, point);
}

/// Two facets that may lie on one another.
struct FacetPair {
  std::int32_t first, second;  // of their faces
  Overlap overlap;
};

/// The faces that lie on one face.
class FaceOverlaps {
public:
  FaceOverlaps(const cad::Model& model, const ModelFacets& all, const std::vector<std::int32_t>& first_facets,
               FaceId face, const cad::Facets& facets, double extent)
      : _model(model),
        _all(all),
        _first_facets(first_facets),
        _face(face),
        _facets(facets),
        _within(nearest_walls * extent),
        _within_gap(std::max(_within, std::min(nearest_in_gap * extent, widest_gap_on(face)))) {}

  /// By about so many nodes of the tree at most.
  std::vector<CoincidentFaces> find(std::int64_t most) {
    std::int64_t nodes = 0;
    for (std::size_t i = 0; i < _facets.triangles.size() && nodes < most; ++i)
      look_at(static_cast<std::int32_t>(i), nodes);
    std::vector<CoincidentFaces> found;
    for (auto& [other, pairs] : _pairs) {
      const double least = least_part * std::min(_model.face_area(_face), _model.face_area(other));
      const PairFindings findings = measure(other, pairs);
      const Nearness &walls = findings.walls, &gap = findings.gap;
      if (walls.faces.area > least && findings.width() > _within) {
        found.push_back(walls.faces);
      } else if (gap.faces.area > least && gap.triangles > most_triangles_in_gap) {
        found.push_back(gap.faces);
        found.back().triangles = gap.triangles;
      }
    }
    return found;
  }

private:
  /// Wider ones take fewer triangles on a face than are too many.
  double widest_gap_on(FaceId face) const {
    return std::sqrt(triangles_per_area * _model.face_area(face) / most_triangles_in_gap);
  }

  void look_at(std::int32_t facet, std::int64_t& nodes) {
    const std::int32_t number = _first_facets[_face] + facet;
    const auto& [face, corners, parameters, deviation, curvature] = _all.items[number];
    const Vec3 normal = _all.normals[number];
    if (!(norm(normal) > 0.5)) return;
    const auto faces_it = [&](std::int32_t other) {
      const FaceId beyond = _all.items[other].face;
      return beyond != _face && std::abs(dot(normal, _all.normals[other])) >= least_cosine &&
             !_model.is_far_field(beyond);
    };
    _near.clear();
    _all.rays.find_near(corners, _within_gap + 2 * deviation, faces_it, _near, nodes);
    for (const std::int32_t other : _near) {
      const ModelFacet& beyond = _all.items[other];
      const Vec3 other_normal = _all.normals[other];
      const Overlap overlap = overlap_of(corners, normal, beyond.corners);
      if (!(overlap.area > least_overlap * std::min(area_of(corners), area_of(beyond.corners)))) continue;
      const double apart = std::abs(dot(overlap.middle - beyond.corners[0], other_normal));
      if (apart > _within_gap + 2 * (deviation + beyond.deviation)) continue;
      _pairs[beyond.face].push_back({facet, other - _first_facets[beyond.face], overlap});
    }
  }

  /// Where two faces are near each other.
  struct Nearness {
    CoincidentFaces faces;
    double triangles = 0;  ///< on one of them, as small as they are near

    void add(Vec3 place, double apart, double area) {
      if (faces.area == 0) faces.place = place;
      faces.area += area;
      faces.apart = std::max(faces.apart, apart);
      triangles += triangles_per_area * area / (apart * apart);
    }
  };
  struct PairFindings {
    Nearness walls, gap;  ///< on either side, up to nearest_walls; where that is meshed, up to nearest_in_gap
    double length = 0;    ///< of the box around all places that may be near

    /// Of a strip that is as long, and has the area of the walls.
    double width() const { return walls.faces.area / length; }
  };

  /// How far two faces lie on one another, judged where their facets overlap most.
  PairFindings measure(FaceId other, std::vector<FacetPair>& pairs) {
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const FacetPair& a, const FacetPair& b) { return a.overlap.area > b.overlap.area; });
    const cad::Facets of_other = sampling_facets(_model, other, false);
    const SegmentTree common = common_edges(other);
    const CoincidentFaces none{_face, other, 0, {}, 0};
    PairFindings found{{none}, {none}};
    geometry::Box box;
    double all = 0, looked_at = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      all += pairs[i].overlap.area;
      box.add(pairs[i].overlap.box);
      if (i >= places_looked_at) continue;
      looked_at += pairs[i].overlap.area;
      const auto [place, apart, is_meshed] = distance_at(other, of_other, pairs[i]);
      if (!(apart <= _within_gap)) continue;
      const double reach = std::max(apart / least_wedge, _within);
      if (common.nearest(place, reach) < reach) continue;
      if (apart <= _within) found.walls.add(place, apart, pairs[i].overlap.area);
      if (is_meshed) found.gap.add(place, apart, pairs[i].overlap.area);
    }
    found.length = box.diagonal();
    for (Nearness* each : {&found.walls, &found.gap}) {
      each->faces.area *= looked_at > 0 ? all / looked_at : 0;
      each->triangles *= looked_at > 0 ? all / looked_at : 0;
    }
    return found;
  }

  struct Distance {
    Vec3 place;
    double apart;
    bool is_meshed;  ///< what is in between
  };
  Distance distance_at(FaceId other, const cad::Facets& of_other, const FacetPair& pair) const {
    const cad::SurfaceFrame at =
        _model.face_frame(_face, parameters_at(_facets, pair.first, pair.overlap.middle));
    const Vec2 guess = parameters_at(of_other, pair.second, pair.overlap.middle);
    const cad::Projection foot = _model.project(other, at.point, guess);
    if (!foot.converged) return {at.point, std::numeric_limits<double>::infinity(), false};
    return {at.point, distance(at.point, foot.point), dot(foot.point - at.point, at.normal) < 0};
  }

  SegmentTree common_edges(FaceId other) const {
    std::vector<SegmentTree::Segment> segments;
    for (const cad::Facets::BoundaryLine& line : _facets.boundary) {
      const std::vector<FaceId>& users = _model.edge(line.use.edge).faces;
      if (std::find(users.begin(), users.end(), other) == users.end()) continue;
      for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i)
        segments.push_back({_facets.points[line.nodes[i]], _facets.points[line.nodes[i + 1]], 0});
    }
    return SegmentTree(std::move(segments));
  }

  const cad::Model& _model;
  const ModelFacets& _all;
  const std::vector<std::int32_t>& _first_facets;  // of each face
  FaceId _face;
  const cad::Facets& _facets;
  double _within, _within_gap;
  std::vector<std::int32_t> _near;
  std::map<FaceId, std::vector<FacetPair>> _pairs;  // by the other face
};

/// The two faces have seen each other, mostly: the larger area counts.
std::vector<CoincidentFaces> merge(std::vector<CoincidentFaces> all) {
  for (CoincidentFaces& each : all) {
    if (each.first > each.second) std::swap(each.first, each.second);
  }
  geometry::sort_unique(
      all,
      [](const CoincidentFaces& a, const CoincidentFaces& b) {
        return std::tuple(a.first, a.second, -a.area) < std::tuple(b.first, b.second, -b.area);
      },
      [](const CoincidentFaces& a, const CoincidentFaces& b) {
        return a.first == b.first && a.second == b.second;
      });
  std::stable_sort(all.begin(), all.end(),
                   [](const CoincidentFaces& a, const CoincidentFaces& b) { return a.area > b.area; });
  return all;
}

}  // namespace

std::vector<CoincidentFaces> find_coincident_faces(const SampledModel& sampled) {
  const cad::Model& model = sampled.model();
  const ModelFacets& all = sampled.facets();
  const Vec3 size = sampled.body_box().size();
  const double extent = std::max({size.x, size.y, size.z});
  std::vector<CoincidentFaces> mine;
  parallel::collectively(sampled.communicator(), ScopedCpu::As::task, [&] {
    std::vector<std::int32_t> first_facets(model.face_count(), -1);
    for (std::size_t w = all.items.size(); w-- > 0;)
      first_facets[all.items[w].face] = static_cast<std::int32_t>(w);
    for (const SampledFace& face : sampled.own_faces()) {
      if (model.is_far_field(face.id) || first_facets[face.id] < 0) continue;
      const double part =
          static_cast<double>(face.facets.triangles.size()) / static_cast<double>(all.items.size());
      const std::int64_t most = few_tree_nodes + std::llround(part * most_tree_nodes);
      const auto found = FaceOverlaps(model, all, first_facets, face.id, face.facets, extent).find(most);
      mine.insert(mine.end(), found.begin(), found.end());
    }
  });
  return merge(sampled.communicator().all_gather_items<CoincidentFaces>(mine));
}

}  // namespace aeroloom::sizing
