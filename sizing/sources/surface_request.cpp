#include "sizing/sources/surface_request.hpp"

#include "cad/model/patches.hpp"
#include "sizing/features/segment_tree.hpp"
#include "sizing/features/trailing_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {

using geometry::Box;
using geometry::Vec3;

namespace {

constexpr int triangles_per_leaf = 8;
/// Of each smooth part of an edge; chosen, not measured.
constexpr int edge_intervals = 32;
/// A trailing edge is swept by 60 degrees at most, the faces ahead of it lie within 60 degrees of the way it
/// points, those behind a blunt one turn off by as much at least, and the body turns by 30 degrees at least.
constexpr double least_across = 0.5, least_ahead = 0.5, least_turn = 0.866;

double slope_of(const SizedTriangle& t) {
  double steepest = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double length = distance(t.corners[i], t.corners[j]);
    if (length > 0) steepest = std::max(steepest, std::abs(t.sizes[i] - t.sizes[j]) / length);
  }
  return steepest;
}

std::vector<std::array<Vec3, 2>> segments_of(const cad::Model& model, cad::EdgeId edge) {
  std::vector<std::array<Vec3, 2>> segments;
  const std::vector<double> breaks = model.edge_breaks(edge);
  for (std::size_t part = 0; part + 1 < breaks.size(); ++part) {
    Vec3 last = model.edge_point(edge, breaks[part]);
    for (int i = 1; i <= edge_intervals; ++i) {
      const double t = breaks[part] + (breaks[part + 1] - breaks[part]) * i / edge_intervals;
      const Vec3 next = model.edge_point(edge, t);
      segments.push_back({last, next});
      last = next;
    }
  }
  return segments;
}

/// A face at the middle of one of its edges.
struct FaceAtEdge {
  Vec3 normal, into;  ///< unit; along the face, off the edge
};

FaceAtEdge face_at(const cad::Model& model, cad::FaceId face, cad::EdgeId edge) {
  const cad::Edge& e = model.edge(edge);
  const double t = 0.5 * (e.first_parameter + e.last_parameter);
  for (const auto& loop : model.face(face).loops) {
    for (const cad::Coedge& use : loop) {
      if (use.edge != edge) continue;
      const Vec3 normal = model.face_frame(face, model.edge_uv(face, use, t)).normal;
      const Vec3 along = (use.reversed ? -1.0 : 1.0) * normalized(model.edge_tangent(edge, t));
      return {normal, cross(normal, along)};
    }
  }
  return {};
}

bool is_trailing(const cad::Model& model, cad::EdgeId edge, const std::vector<bool>& faces, Vec3 direction) {
  const cad::Edge& e = model.edge(edge);
  if (e.degenerate || e.faces.size() != 2 || (!faces[e.faces[0]] && !faces[e.faces[1]])) return false;
  const Vec3 along = normalized(model.edge_tangent(edge, 0.5 * (e.first_parameter + e.last_parameter)));
  const Vec3 across = direction - dot(direction, along) * along;
  if (norm(across) < least_across) return false;
  const Vec3 behind = normalized(across);
  const FaceAtEdge a = face_at(model, e.faces[0], edge), b = face_at(model, e.faces[1], edge);
  // Normals point out of the fluid.
  const bool is_convex = dot(a.normal, b.into) > 0 && dot(a.into, b.into) > -least_turn;
  if (!is_convex) return false;
  const double of_a = dot(a.into, behind), of_b = dot(b.into, behind);
  if (std::max(of_a, of_b) > least_ahead) return false;
  return (faces[e.faces[0]] && of_a < -least_ahead) || (faces[e.faces[1]] && of_b < -least_ahead);
}

/// Both borders of a face, where that is a blunt trailing edge whose neighbours are not named themselves.
void add_borders_of_strip(const cad::Model& model, cad::FaceId face, const std::vector<bool>& faces,
                          Vec3 direction, std::vector<std::array<Vec3, 2>>& segments) {
  const std::optional<TrailingCandidate> candidate = blunt_candidate(model, face, normalized(direction));
  if (!candidate || std::any_of(candidate->neighbours.begin(), candidate->neighbours.end(),
                                [&](cad::FaceId f) { return faces[f]; }))
    return;
  for (const std::vector<Vec3>& border : {candidate->element.trailing.points, candidate->element.opposite}) {
    for (std::size_t i = 0; i + 1 < border.size(); ++i) segments.push_back({border[i], border[i + 1]});
  }
}

/// The part of a segment inside a box; false where there is none.
bool clip(std::array<Vec3, 2>& segment, const Box& box) {
  double first = 0, last = 1;
  const Vec3 from = segment[0], way = segment[1] - segment[0];
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (from[axis] < box.low[axis] || from[axis] > box.high[axis]) return false;
      continue;
    }
    const double a = (box.low[axis] - from[axis]) / way[axis], b = (box.high[axis] - from[axis]) / way[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first > last) return false;
  segment = {from + first * way, from + last * way};
  return true;
}

}  // namespace

NearestOfTriangle nearest_of(const Triangle& t, Vec3 p) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double square = dot(normal, normal);
  if (square > 0) {
    std::array<double, 3> weights{};
    for (int i = 0; i < 3; ++i) {
      const Vec3 from = t[(i + 1) % 3], to = t[(i + 2) % 3];
      weights[i] = dot(cross(to - from, p - from), normal) / square;
    }
    if (*std::min_element(weights.begin(), weights.end()) >= 0)
      return {std::abs(dot(p - t[0], normal)) / std::sqrt(square), weights};
  }
  NearestOfTriangle nearest{no_size, {}};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vec3 way = t[j] - t[i];
    const double length = dot(way, way);
    const double place = length > 0 ? std::clamp(dot(p - t[i], way) / length, 0.0, 1.0) : 0;
    const double away = distance(p, t[i] + place * way);
    if (away >= nearest.away) continue;
    nearest = {away, {}};
    nearest.weights[i] = 1 - place;
    nearest.weights[j] += place;
  }
  return nearest;
}

SurfaceRequest::SurfaceRequest(std::string key, std::vector<SizedTriangle> triangles, double reach)
    : _key(std::move(key)), _reach(reach) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Vec3 corner : triangles[i].corners) boxes[i].add(corner);
    for (const double size : triangles[i].sizes) _smallest = std::min(_smallest, size);
    _slope = std::max(_slope, slope_of(triangles[i]));
  }
  _tree = geometry::BoxTree(boxes, triangles_per_leaf);
  _triangles.reserve(triangles.size());
  for (const std::int32_t i : _tree.order()) _triangles.push_back(triangles[i]);
}

CubeRequest SurfaceRequest::request_in(Vec3 middle, double half_edge, double coarsening) const {
  const double around = std::numbers::sqrt3 * half_edge, reach = _reach + around;
  double size = no_size;
  // With the smallest size found nothing else can matter.
  const auto enters = [&](const Box& box) {
    return size > _smallest && distance_to_box(middle, box) <= reach;
  };
  _tree.search(enters, [&](std::int32_t i) {
    const SizedTriangle& t = _triangles[i];
    const NearestOfTriangle nearest = nearest_of(t.corners, middle);
    if (nearest.away > reach) return;
    double here = 0;
    for (int c = 0; c < 3; ++c) here += nearest.weights[c] * t.sizes[c];
    size = std::min(size, std::max(here, _smallest));
  });
  if (size == no_size) return {};
  return {coarsening * std::max(_smallest, size - _slope * around), coarsening * size};
}

double SurfaceRequest::cells(const RootCube& root, double coarsening) const {
  double cells = 0;
  for (const SizedTriangle& t : _triangles) {
    const double size = coarsening * (t.sizes[0] + t.sizes[1] + t.sizes[2]) / 3;
    const double edge = std::ldexp(root.edge, -root.level(size));
    const double area = area_of(t.corners);
    cells +=
        (area > 0 ? area / (edge * edge) : longest_edge(t.corners).length / edge) * (2 * _reach / edge + 1);
  }
  return cells;
}

void require_like(const cad::Model& model, const std::string& key, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    const std::vector<bool> found = faces_like(model, {pattern});
    if (std::find(found.begin(), found.end(), true) == found.end())
      throw std::invalid_argument(
          fmt::format("{}: no face and no patch of this model is like '{}'. Remedy: `aeroloom check` lists "
                      "the patches; * "
                      "stands for any characters, ? for one",
                      key, pattern));
  }
}

std::vector<bool> faces_like(const cad::Model& model, const std::vector<std::string>& patterns) {
  const std::vector<cad::NamePattern> compiled(patterns.begin(), patterns.end());
  std::vector<bool> like(model.face_count());
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const cad::Face& face = model.face(f);
    like[f] = std::any_of(compiled.begin(), compiled.end(), [&](const cad::NamePattern& pattern) {
      return pattern.matches(face.name) || pattern.matches(model.patches()[face.patch]);
    });
  }
  return like;
}

std::vector<std::array<Vec3, 2>> trailing_segments(const cad::Model& model, const std::vector<bool>& faces,
                                                   Vec3 direction) {
  std::vector<std::array<Vec3, 2>> segments;
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    if (!is_trailing(model, e, faces, direction)) continue;
    const auto more = segments_of(model, e);
    segments.insert(segments.end(), more.begin(), more.end());
  }
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (faces[f]) add_borders_of_strip(model, f, faces, direction, segments);
  }
  return segments;
}

std::vector<SizedTriangle> wake_sheet(const std::vector<std::array<Vec3, 2>>& segments,
                                      const WakeSize& wake) {
  std::vector<SizedTriangle> sheet;
  const Vec3 way = wake.shape.length * normalized(wake.shape.direction);
  for (const auto& [a, b] : segments) {
    sheet.push_back({{a, b, b + way}, {wake.size, wake.size, wake.end_size()}});
    sheet.push_back({{a, b + way, a + way}, {wake.size, wake.end_size(), wake.end_size()}});
  }
  return sheet;
}

std::vector<cad::EdgeId> edges_like(const cad::Model& model, const EdgeSize& asked) {
  std::vector<std::vector<bool>> sides;
  for (const std::string& pattern : asked.between) sides.push_back(faces_like(model, {pattern}));
  const auto is_asked_for = [&](const std::vector<cad::FaceId>& faces) {
    if (sides.size() < 2)
      return sides.empty() ||
             std::any_of(faces.begin(), faces.end(), [&](cad::FaceId f) { return sides[0][f]; });
    for (const cad::FaceId f : faces) {
      for (const cad::FaceId g : faces) {
        if (f != g && sides[0][f] && sides[1][g]) return true;
      }
    }
    return false;
  };
  std::vector<cad::EdgeId> found;
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    if (!model.edge(e).degenerate && !model.is_seam(e) && is_asked_for(model.edge(e).faces))
      found.push_back(e);
  }
  return found;
}

std::vector<SizedTriangle> edges_asked_for(const cad::Model& model, const EdgeSize& asked) {
  std::vector<SizedTriangle> found;
  for (const cad::EdgeId e : edges_like(model, asked)) {
    if (asked.size_at_ends > 0) {
      for (const cad::VertexId v : {model.edge(e).first, model.edge(e).last}) {
        const Vec3 end = model.vertex(v);
        found.push_back({{end, end, end}, {asked.size_at_ends, asked.size_at_ends, asked.size_at_ends}});
      }
    }
    for (std::array<Vec3, 2> segment : segments_of(model, e)) {
      if (asked.within && !clip(segment, *asked.within)) continue;
      found.push_back({{segment[0], segment[1], segment[1]}, {asked.size, asked.size, asked.size}});
    }
  }
  return found;
}

void require_faces(const cad::Model& model, const SizeRequests& requests) {
  for (const WallSize& wall : requests.walls) require_like(model, "sizing.walls." + wall.name, wall.faces);
  for (const WakeSize& wake : requests.wakes)
    require_like(model, "sizing.sources." + wake.name, wake.shape.behind);
  for (const EdgeSize& edge : requests.edges) require_like(model, "sizing.edges." + edge.name, edge.between);
}

}  // namespace aeroloom::sizing
