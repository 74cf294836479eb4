#include "sizing/proximity.hpp"

#include "sizing/segment_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

constexpr double facing = -0.5;          // largest cosine between normals of walls that face each other
constexpr double edge_per_size = 4;      // of facets that one ray stands for
constexpr double wedge_slenderness = 8;  // distance to the common edge over the gap
constexpr int deepest_bisection = 24;

Vec3 unit_normal(const Triangle& t) {
  return normalized(cross(t[1] - t[0], t[2] - t[0]));
}

class GapFinder {
public:
  GapFinder(const cad::Model& model, const cad::Facets& facets, const Walls& walls, double widest,
            double finest, double layers)
      : _facets(facets),
        _walls(walls),
        _widest(widest),
        _finest(finest),
        _edge_per_gap(edge_per_size / std::max(1.0, layers)) {
    std::map<cad::FaceId, std::vector<SegmentTree::Segment>> shared;
    for (const cad::Facets::BoundaryLine& line : facets.boundary) {
      for (const cad::FaceId user : model.edge(line.use.edge).faces) {
        for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i)
          shared[user].push_back({facets.points[line.nodes[i]], facets.points[line.nodes[i + 1]], user});
      }
    }
    for (auto& [user, segments] : shared) _edges.emplace(user, std::move(segments));
  }

  std::vector<Gap> run() {
    for (const auto& t : _facets.triangles) {
      cover({_facets.points[t[0]], _facets.points[t[1]], _facets.points[t[2]]}, 0);
    }
    return std::move(_gaps);
  }

private:
  void cover(const Triangle& t, int depth) {
    const Vec3 center = (t[0] + t[1] + t[2]) / 3;
    const Vec3 normal = unit_normal(t);
    if (!(norm(normal) > 0.5)) return;
    const double gap = look(center, normal);
    if (gap <= _widest) _gaps.push_back({center, gap});
    int longest = 0;
    double length = 0;
    for (int i = 0; i < 3; ++i) {
      const double edge = distance(t[i], t[(i + 1) % 3]);
      if (edge > length) length = edge, longest = i;
    }
    // Without a gap in sight the facet is searched as closely as gaps of the widest kind would need.
    const double fine = std::max(_finest, _edge_per_gap * std::min(gap, _widest));
    if (length <= fine || depth >= deepest_bisection) return;
    const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3], middle = 0.5 * (a + b);
    cover({a, middle, c}, depth + 1);
    cover({middle, b, c}, depth + 1);
  }

  /// Distance along the normal, to either side, to the nearest wall that faces back, the lower one where two
  /// are as near; infinity where there is none in reach.
  double look(Vec3 from, Vec3 normal) const {
    double nearest = std::numeric_limits<double>::infinity();
    const auto faces_back = [&](std::int32_t triangle) {
      return dot(_walls.normals[triangle], normal) <= facing;
    };
    for (const auto& [wall, away] : _walls.tree.nearest_crossings(from, normal, _widest, faces_back)) {
      if (wall >= 0 && away < nearest && !in_wedge(from, _walls.faces[wall], away)) nearest = away;
    }
    return nearest;
  }

  /// Whether the face meets the opposite one (or itself) in an edge so near that gap and edge form a wedge.
  bool in_wedge(Vec3 point, cad::FaceId opposite, double gap) const {
    const auto edges = _edges.find(opposite);
    if (edges == _edges.end()) return false;
    const double reach = wedge_slenderness * gap;
    return edges->second.nearest(point, reach, [](std::int32_t) { return true; }) < reach;
  }

  const cad::Facets& _facets;
  const Walls& _walls;
  std::map<cad::FaceId, SegmentTree>
      _edges;  // that the face shares with each neighbour; all of them with itself
  double _widest, _finest, _edge_per_gap;
  std::vector<Gap> _gaps;
};

}  // namespace

Walls::Walls(const std::vector<Triangle>& triangles_of_walls, std::vector<cad::FaceId> faces_of_walls)
    : tree(triangles_of_walls), faces(std::move(faces_of_walls)) {
  normals.reserve(triangles_of_walls.size());
  for (const Triangle& t : triangles_of_walls) normals.push_back(unit_normal(t));
}

std::vector<Gap> find_gaps(const cad::Model& model, const cad::Facets& facets, const Walls& walls,
                           double widest, double finest, double layers) {
  return GapFinder(model, facets, walls, widest, finest, layers).run();
}

}  // namespace aeroloom::sizing
