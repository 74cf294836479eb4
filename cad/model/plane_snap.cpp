#include "cad/model/plane_snap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace aeroloom::cad {
namespace {

constexpr double angular_tolerance = 1e-9;  // of a normal against the axis
constexpr double merge_share = 1e-9;        // of the diagonal: positions closer than this are one
constexpr double leave_share = 1e-6;        // of the diagonal: edges further off are not on the plane

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
    if (std::hypot(u, v) <= angular_tolerance) return Plane{axis, jet.point[axis], id};
  }
  return std::nullopt;
}

/// Gives planes that nearly coincide one position: the least of theirs, or zero.
void merge_positions(std::vector<Plane>& planes, double diagonal) {
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) {
    if (a.axis != b.axis) return a.axis < b.axis;
    return a.position != b.position ? a.position < b.position : a.face < b.face;
  });
  const double near = merge_share * diagonal;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (std::abs(planes[i].position) <= near) planes[i].position = 0;
    if (i == 0 || planes[i].axis != planes[i - 1].axis) continue;
    if (std::abs(planes[i].position - planes[i - 1].position) <= near)
      planes[i].position = planes[i - 1].position;
  }
}

double distance_from(const Model::Data& data, EdgeId id, const Plane& plane) {
  constexpr int samples = 16;
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

}  // namespace

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
      if (distance_from(data, edge, plane) > leave_share * diagonal) continue;
      data.edge_snaps[edge].fix(plane.axis, plane.position);
      data.vertex_snaps[data.edges[edge].first].fix(plane.axis, plane.position);
      data.vertex_snaps[data.edges[edge].last].fix(plane.axis, plane.position);
    }
  }
}

}  // namespace aeroloom::cad
