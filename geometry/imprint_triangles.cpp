#include "geometry/imprint_triangles.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

namespace aeroloom::geometry {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Exact::Point_3;
using PlanePoint = Exact::Point_2;
struct PointNumber {
  std::int32_t value = -1;  ///< among the points; none yet
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<PointNumber, Exact>;
using Structure =
    CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Constrained_triangulation_face_base_2<Exact>>;
using PlaneTriangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Exact, Structure, CGAL::Exact_intersections_tag>;

/// Triangles in one plane, and what touches them there.
struct PlaneCluster {
  std::vector<std::int32_t> triangles;
  std::vector<std::pair<ExactPoint, ExactPoint>> segments;  ///< a point twice: a point
};

class TriangleImprinter {
public:
  TriangleImprinter(std::span<const Vec3> points, std::span<const TriangleCorners> triangles)
      : _triangles(triangles), _parts(triangles.size()) {
    _result.points.assign(points.begin(), points.end());
  }

  ImprintedTriangles run(std::span<const std::array<std::int32_t, 2>> contacts) {
    std::map<std::int32_t, PlaneCluster> clusters;
    gather(contacts, clusters);
    if (_result.crossing) return std::move(_result);
    for (const auto& [root, cluster] : clusters) cut(cluster);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_triangles.size()); ++t) {
      if (_parts[t].size() < 2) _parts[t] = {_triangles[t]};
      _result.cut += _parts[t].size() > 1;
      for (const TriangleCorners& part : _parts[t]) {
        _result.triangles.push_back(part);
        _result.sources.push_back(t);
      }
    }
    return std::move(_result);
  }

private:
  ExactPoint exact(std::int32_t p) const {
    const Vec3 at = _result.points[p];
    return {at.x, at.y, at.z};
  }
  Exact::Triangle_3 exact_triangle(std::int32_t t) const {
    const auto& [a, b, c] = _triangles[t];
    return {exact(a), exact(b), exact(c)};
  }
  static bool coplanar(const Exact::Triangle_3& s, const Exact::Triangle_3& t) {
    const Exact::Plane_3 plane = s.supporting_plane();
    return plane.has_on(t[0]) && plane.has_on(t[1]) && plane.has_on(t[2]);
  }
  /// Whether t lies on one side of the plane of s, or in it.
  static bool on_one_side(const Exact::Triangle_3& s, const Exact::Triangle_3& t) {
    bool above = false, below = false;
    for (int i = 0; i < 3; ++i) {
      const CGAL::Orientation side = CGAL::orientation(s[0], s[1], s[2], t[i]);
      above = above || side == CGAL::POSITIVE, below = below || side == CGAL::NEGATIVE;
    }
    return !(above && below);
  }

  /// Unites triangles of one plane that meet, and lists what others have in common with each plane.
  void gather(std::span<const std::array<std::int32_t, 2>> contacts,
              std::map<std::int32_t, PlaneCluster>& clusters) {
    DisjointSets<std::int32_t> planes(_triangles.size());
    std::vector<std::pair<std::int32_t, std::pair<ExactPoint, ExactPoint>>> touching;
    std::vector<std::int32_t> touched;
    for (const auto& pair : contacts) {
      const Exact::Triangle_3 s = exact_triangle(pair[0]), t = exact_triangle(pair[1]);
      touched.insert(touched.end(), pair.begin(), pair.end());
      if (coplanar(s, t)) {
        planes.unite(pair[0], pair[1]);
        continue;
      }
      const auto common = CGAL::intersection(s, t);
      if (!common) continue;
      std::pair<ExactPoint, ExactPoint> ends;
      if (const auto* segment = boost::get<Exact::Segment_3>(&*common)) {
        if (!on_one_side(s, t) && !on_one_side(t, s)) {
          _result.crossing = pair;
          return;
        }
        ends = {segment->source(), segment->target()};
      } else if (const auto* point = boost::get<ExactPoint>(&*common)) {
        ends = {*point, *point};
      }
      for (const std::int32_t each : pair) touching.emplace_back(each, ends);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::int32_t t : touched) clusters[planes.root(t)].triangles.push_back(t);
    for (auto& [t, ends] : touching) clusters[planes.root(t)].segments.push_back(std::move(ends));
  }

  /// A plane seen along the axis that is most nearly normal to it.
  struct View {
    Exact::Plane_3 plane;
    int axis;

    PlanePoint operator()(const ExactPoint& p) const { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }
    ExactPoint lifted(const PlanePoint& p) const {
      const Exact::FT normal[3] = {plane.a(), plane.b(), plane.c()};
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Exact::FT at[3];
      at[u] = p.x(), at[v] = p.y();
      at[axis] = -(normal[u] * p.x() + normal[v] * p.y() + plane.d()) / normal[axis];
      return {at[0], at[1], at[2]};
    }
  };
  View view_of(std::int32_t t) const {
    const auto& [a, b, c] = _triangles[t];
    const Vec3 normal = cross(_result.points[b] - _result.points[a], _result.points[c] - _result.points[a]);
    View view{exact_triangle(t).supporting_plane(), 0};
    const Exact::FT exact_normal[3] = {view.plane.a(), view.plane.b(), view.plane.c()};
    for (int axis = 1; axis < 3; ++axis)
      if (std::abs(normal[axis]) > std::abs(normal[view.axis])) view.axis = axis;
    for (int axis = 0; axis < 3 && exact_normal[view.axis] == 0; ++axis)
      if (exact_normal[axis] != 0) view.axis = axis;
    return view;
  }

  void cut(const PlaneCluster& cluster) {
    const View view = view_of(cluster.triangles.front());
    PlaneTriangulation plane;
    for (const std::int32_t t : cluster.triangles) {
      for (const std::int32_t p : _triangles[t]) plane.insert(view(exact(p)))->info().value = p;
    }
    for (const std::int32_t t : cluster.triangles) {
      for (int i = 0; i < 3; ++i)
        plane.insert_constraint(view(exact(_triangles[t][i])), view(exact(_triangles[t][(i + 1) % 3])));
    }
    for (const auto& [a, b] : cluster.segments) {
      if (a == b) {
        plane.insert(view(a));
      } else {
        plane.insert_constraint(view(a), view(b));
      }
    }
    number_new_points(plane, view);
    share_out(plane, view, cluster);
  }

  void number_new_points(PlaneTriangulation& plane, const View& view) {
    for (auto vertex = plane.finite_vertices_begin(); vertex != plane.finite_vertices_end(); ++vertex) {
      if (vertex->info().value >= 0) continue;
      const ExactPoint at = view.lifted(vertex->point());
      vertex->info().value = static_cast<std::int32_t>(_result.points.size());
      _result.points.push_back({CGAL::to_double(CGAL::exact(at.x())), CGAL::to_double(CGAL::exact(at.y())),
                                CGAL::to_double(CGAL::exact(at.z()))});
    }
  }

  /// Gives each triangle of the plane to those of the cluster that contain it.
  void share_out(const PlaneTriangulation& plane, const View& view, const PlaneCluster& cluster) {
    std::vector<std::array<PlanePoint, 3>> corners;
    std::vector<Box> boxes;
    for (const std::int32_t t : cluster.triangles) {
      const auto& [a, b, c] = _triangles[t];
      corners.push_back({view(exact(a)), view(exact(b)), view(exact(c))});
      Box& box = boxes.emplace_back();
      for (const std::int32_t p : _triangles[t]) box.add(_result.points[p]);
    }
    const BoxTree tree(boxes, 8);
    for (auto face = plane.finite_faces_begin(); face != plane.finite_faces_end(); ++face) {
      TriangleCorners part{};
      Box box;
      for (int i = 0; i < 3; ++i) part[i] = face->vertex(i)->info().value, box.add(_result.points[part[i]]);
      const PlanePoint middle =
          CGAL::centroid(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
      for_each_overlap(tree, boxes, box, [&](std::int32_t i) {
        const auto& [a, b, c] = corners[i];
        const CGAL::Orientation turn = CGAL::orientation(a, b, c);
        if (CGAL::orientation(a, b, middle) != turn || CGAL::orientation(b, c, middle) != turn ||
            CGAL::orientation(c, a, middle) != turn)
          return;
        TriangleCorners turned = part;
        if (turn == CGAL::NEGATIVE) std::swap(turned[1], turned[2]);
        _parts[cluster.triangles[i]].push_back(turned);
      });
    }
  }

  std::span<const TriangleCorners> _triangles;
  std::vector<std::vector<TriangleCorners>> _parts;  // of each triangle; empty: itself
  ImprintedTriangles _result;
};

}  // namespace

ImprintedTriangles imprint_triangles(std::span<const Vec3> points, std::span<const TriangleCorners> triangles,
                                     std::span<const std::array<std::int32_t, 2>> contacts) {
  return TriangleImprinter(points, triangles).run(contacts);
}

}  // namespace aeroloom::geometry
