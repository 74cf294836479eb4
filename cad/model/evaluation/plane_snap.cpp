#include "cad/model/evaluation/plane_snap.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>

namespace aeroloom::cad {
namespace {

struct Plane {
  int axis;
  double position;
  FaceId face;
};

std::optional<Plane> aligned_plane(const Model::Data& data, FaceId id) {
  const FaceEvaluator& face = data.face_evaluators[id];
  if (!face.planar) return std::nullopt;
  const Vec2 middle = 0.5 * (face.uv_low + face.uv_high);
  const SurfaceJet jet = face.surface.jet(middle, 1);
  const Vec3 normal = normalized(cross(jet.du, jet.dv));
  for (int axis = 0; axis < 3; ++axis) {
    const double u = normal[(axis + 1) % 3], v = normal[(axis + 2) % 3];
    if (std::hypot(u, v) <= tolerances::parallel) return Plane{axis, jet.point[axis], id};
  }
  return std::nullopt;
}

/// Gives planes that nearly coincide one position: the least of theirs, or zero.
void merge_positions(std::vector<Plane>& planes, double diagonal) {
  std::ranges::sort(planes, [](const Plane& a, const Plane& b) {
    if (a.axis != b.axis) return a.axis < b.axis;
    return a.position != b.position ? a.position < b.position : a.face < b.face;
  });
  const double near = tolerances::coincident * diagonal;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (std::abs(planes[i].position) <= near) planes[i].position = 0;
    if (i == 0 || planes[i].axis != planes[i - 1].axis) continue;
    if (std::abs(planes[i].position - planes[i - 1].position) <= near)
      planes[i].position = planes[i - 1].position;
  }
}

double distance_from(const Model::Data& data, EdgeId id, const Plane& plane) {
  constexpr int samples = 16;  // along the edge, as in distance_of_moved()
  const Edge& edge = data.edges[id];
  double largest = std::max(std::abs(data.vertices[edge.first][plane.axis] - plane.position),
                            std::abs(data.vertices[edge.last][plane.axis] - plane.position));
  if (edge.degenerate) return largest;
  for (int i = 0; i <= samples; ++i) {
    const double t = edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / samples;
    const gp_Pnt p = data.edge_evaluators[id].curve.Value(t);
    largest = std::max(largest, std::abs(p.Coord(plane.axis + 1) - plane.position));
  }
  return largest;
}

/// Largest distance of the edges that moved from the plane of a face.
double distance_of_moved(const Model::Data& data, FaceId id, const std::vector<char>& moved) {
  constexpr int samples = 16;
  const FaceEvaluator& face = data.face_evaluators[id];
  const SurfaceJet jet = face.surface.jet(0.5 * (face.uv_low + face.uv_high), 1);
  const Vec3 normal = normalized(cross(jet.du, jet.dv));
  double largest = 0;
  for (const Coedge& use : data.faces[id].loops | std::views::join) {
    const Edge& edge = data.edges[use.edge];
    if (!moved[use.edge] || edge.degenerate) continue;
    for (int i = 0; i <= samples; ++i) {
      const gp_Pnt p = data.edge_evaluators[use.edge].curve.Value(
          edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / samples);
      largest = std::max(largest, std::abs(dot(Vec3{p.X(), p.Y(), p.Z()} - jet.point, normal)));
    }
  }
  return largest;
}

/// Gives an edge and its vertices a coordinate.
void fix_edge(Model::Data& data, EdgeId id, int axis, double position) {
  data.edge_snaps[id].fix(axis, position);
  data.vertex_snaps[data.edges[id].first].fix(axis, position);
  data.vertex_snaps[data.edges[id].last].fix(axis, position);
}

/// Gives the moved edges of an exact plane its coordinate.
void fix_moved(Model::Data& data, FaceId id, const std::vector<char>& moved) {
  const Snap& snap = data.face_snaps[id];
  for (const Coedge& use : data.faces[id].loops | std::views::join) {
    for (int axis = 0; axis < 3; ++axis) {
      if (moved[use.edge] && snap.fixed[axis]) fix_edge(data, use.edge, axis, snap.value[axis]);
    }
  }
}

}  // namespace

void mark_planes_again(Model::Data& data, const std::vector<char>& moved) {
  const auto faces = static_cast<FaceId>(data.faces.size());
  for (FaceId id = 0; id < faces; ++id) {
    if (!data.face_evaluators[id].planar) continue;
    if (distance_of_moved(data, id, moved) <= tolerances::coincident * data.bounds.diagonal()) continue;
    data.face_evaluators[id].planar = false;
    data.face_snaps[id] = {};
  }
  for (std::size_t e = 0; e < data.edges.size(); ++e) {
    if (moved[e]) data.edge_snaps[e] = {};
  }
  for (FaceId id = 0; id < faces; ++id) fix_moved(data, id, moved);
}

void mark_exact_planes(Model::Data& data) {
  const double diagonal = data.bounds.diagonal();
  std::vector<Plane> planes;
  for (FaceId id = 0; id < static_cast<FaceId>(data.faces.size()); ++id) {
    if (const auto plane = aligned_plane(data, id)) planes.push_back(*plane);
  }
  merge_positions(planes, diagonal);
  data.vertex_snaps.resize(data.vertices.size());
  data.edge_snaps.resize(data.edges.size());
  data.face_snaps.resize(data.faces.size());
  for (const Plane& plane : planes) {
    data.face_snaps[plane.face].fix(plane.axis, plane.position);
    for (const UseCurve& use : data.face_evaluators[plane.face].uses) {
      const EdgeId edge = use.use.edge;
      if (distance_from(data, edge, plane) > tolerances::same_place * diagonal) continue;
      fix_edge(data, edge, plane.axis, plane.position);
    }
  }
}

}  // namespace aeroloom::cad
