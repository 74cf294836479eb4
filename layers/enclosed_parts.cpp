#include "layers/enclosed_parts.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>

namespace aeroloom::layers {
namespace {

using geometry::Box;
using geometry::Vec3;

constexpr int boxes_per_leaf_of_points = 4;  // chosen, not measured

/// One point of a CAD face.
struct FacePoint {
  std::int32_t face;
  mesh::PieceId piece;
  mesh::LocalIndex vertex;
  std::int32_t unused = 0;  ///< avoids padding
  Vec3 point;
};

bool is_before(const FacePoint& a, const FacePoint& b) {
  return std::tuple(a.face, a.piece, a.vertex) < std::tuple(b.face, b.piece, b.vertex);
}

void keep_first_of_each_face(std::vector<FacePoint>& points) {
  geometry::sort_unique(points, is_before,
                        [](const FacePoint& a, const FacePoint& b) { return a.face == b.face; });
}

/// The first vertex in the first piece of every CAD face. One row per face and rank is sent.
std::vector<FacePoint> points_of_faces(const LocalWall& wall) {
  std::vector<FacePoint> points;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    for (std::int32_t t = wall.first_triangle[p]; t < wall.first_triangle[p + 1]; ++t) {
      const std::int32_t v = std::min({wall.triangles[t][0], wall.triangles[t][1], wall.triangles[t][2]});
      const FacePoint found{wall.faces[t], wall.mesh.pieces[p].id, v - wall.first_vertex[p], 0,
                            wall.points[v]};
      if (points.empty() || points.back().face != found.face) {
        points.push_back(found);
      } else if (is_before(found, points.back())) {
        points.back() = found;
      }
    }
  }
  keep_first_of_each_face(points);
  points = wall.mesh.communicator.all_gather_items(std::span<const FacePoint>(points));
  keep_first_of_each_face(points);
  return points;
}

/// Inside or on the border; flat tetrahedra hold nothing.
bool holds(const std::array<Vec3, 4>& tetrahedron, Vec3 point) {
  const auto& [a, b, c, d] = tetrahedron;
  const int sign = geometry::orient3d(a, b, c, d);
  return sign != 0 && sign * geometry::orient3d(point, b, c, d) >= 0 &&
         sign * geometry::orient3d(a, point, c, d) >= 0 && sign * geometry::orient3d(a, b, point, d) >= 0 &&
         sign * geometry::orient3d(a, b, c, point) >= 0;
}

/// Whether the layers over a triangle contain a point. The diagonals of lateral faces follow from the order
/// of corner coordinates, equal for both triangles at an edge. So no point falls between them.
bool layers_hold(std::array<Vec3, 3> foot, std::array<Vec3, 3> end, Vec3 point) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Vec3 &p = foot[i], &q = foot[j];
    return std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
  });
  const auto [a, b, c] = order;
  return holds({foot[a], foot[b], foot[c], end[c]}, point) ||
         holds({foot[a], foot[b], end[b], end[c]}, point) || holds({foot[a], end[a], end[b], end[c]}, point);
}

}  // namespace

std::vector<std::int32_t> find_enclosing_triangles(const LocalWall& wall, const Fans& fans,
                                                   const std::vector<Vec3>& ends) {
  const std::vector<FacePoint> points = points_of_faces(wall);
  std::vector<Box> boxes;
  boxes.reserve(points.size());
  for (const FacePoint& each : points) boxes.push_back({each.point, each.point});
  const geometry::BoxTree tree(boxes, boxes_per_leaf_of_points);
  const auto encloses = [&](const std::array<std::int32_t, 3>& columns) {
    std::array<Vec3, 3> foot, end;
    Box box;
    for (int i = 0; i < 3; ++i) {
      foot[i] = wall.points[fans.vertex_of(columns[i])];
      end[i] = ends[columns[i]];
      box.add(foot[i]);
      box.add(end[i]);
    }
    bool found = false;
    geometry::for_each_overlap(tree, boxes, box, [&](std::int32_t i) {
      const Vec3 point = points[i].point;
      if (found || std::find(foot.begin(), foot.end(), point) != foot.end()) return;
      found = layers_hold(foot, end, point);
    });
    return found;
  };
  std::vector<std::int32_t> triangles;
  for (std::int32_t t = 0; t < wall.triangle_count(); ++t) {
    if (wall.roles[t] == WallRole::layered && encloses(fans.columns[t])) triangles.push_back(t);
  }
  for (const FanFace& face : fans.faces) {
    const auto& c = face.columns;
    if (encloses({c[0], c[1], c[2]}) || (face.is_sector() && encloses({c[0], c[2], c[3]})))
      triangles.push_back(face.triangle);
  }
  return triangles;
}

}  // namespace aeroloom::layers
