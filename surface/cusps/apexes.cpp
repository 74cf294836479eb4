#include "surface/cusps/apexes.hpp"

#include "cad/model/evaluation/face_corners.hpp"
#include "geometry/angle.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "surface/charts/parameters.hpp"
#include "surface/curves/sharp_corners.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace aeroloom::surface {

namespace {

using geometry::Vec3;

/// Radians of surface around a point. Chosen, not measured.
constexpr double widest_apex = 340 * std::numbers::pi / 180;
constexpr double widest_apex_of_facets = std::numbers::pi;
/// Of the distance to the next point of the chart surface: what tolerances of the CAD model leave between a
/// vertex and the pole of a surface. Chosen, not measured.
constexpr double same_place = 1e-3;
/// Sizes that fit around an apex at the ring of its fan, at least. Chosen, not measured.
constexpr double least_around = 4;
/// The region to replace grows by this factor, at most so often, until it is a disk. Chosen, not measured.
constexpr double growth_of_disk = 1.3;
constexpr int most_disks = 5;

/// The triangles of a chart surface around a point inside of it.
struct Surroundings {
  double angle = 0;                                   ///< of all triangles there together
  double reach = std::numeric_limits<double>::max();  ///< to the nearest other point
};

/// Nothing on the border.
std::optional<Surroundings> look_around(const ChartSurface& surface, std::int32_t point) {
  const auto uses = [&](const auto& edge) { return edge[0] == point || edge[1] == point; };
  if (std::any_of(surface.loop_edges.begin(), surface.loop_edges.end(), uses)) return std::nullopt;
  Surroundings around;
  for (const auto& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] != point) continue;
      const Vec3 out = surface.points[t[(k + 1) % 3]] - surface.points[point];
      const Vec3 back = surface.points[t[(k + 2) % 3]] - surface.points[point];
      around.angle += angle_between(out, back);
      around.reach = std::min(around.reach, norm(out));
    }
  }
  return around;
}

std::int32_t nearest_point(const std::vector<Vec3>& points, Vec3 place) {
  const auto nearer = [&](Vec3 a, Vec3 b) { return distance(a, place) < distance(b, place); };
  return static_cast<std::int32_t>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

/// Per vertex, whether it is removed: those nearer than `radius` that are connected to the nearest one. Empty
/// where one of them has to stay, on the border or at another apex.
std::vector<char> vertices_within(const FaceMesh& mesh, Vec3 place, double radius) {
  std::vector<char> near(mesh.points.size(), 0), within(mesh.points.size(), 0);
  for (std::size_t v = 0; v < near.size(); ++v) near[v] = distance(mesh.points[v], place) < radius;
  within[nearest_point(mesh.points, place)] = 1;
  std::vector<std::array<std::int32_t, 3>> beside;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(beside),
               [&](const auto& t) { return near[t[0]] || near[t[1]] || near[t[2]]; });
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& t : beside) {
      if (!within[t[0]] && !within[t[1]] && !within[t[2]]) continue;
      for (const std::int32_t v : t) {
        if (within[v] || !near[v]) continue;
        within[v] = 1, grows = true;
      }
    }
  }
  const bool has_border =
      std::any_of(within.begin(), within.begin() + mesh.fixed, [](char w) { return w != 0; });
  const bool has_apex = std::any_of(mesh.apexes.begin(), mesh.apexes.end(),
                                    [&](const FaceMesh::ApexVertex& apex) { return within[apex.at]; });
  if (has_border || has_apex) within.clear();
  return within;
}

bool gives_way(const std::array<std::int32_t, 3>& triangle, const std::vector<char>& within) {
  return within[triangle[0]] || within[triangle[1]] || within[triangle[2]];
}

/// The border of the triangles to remove, as one loop; empty where it is no single loop.
std::vector<std::int32_t> ring_around(const FaceMesh& mesh, const std::vector<char>& within) {
  std::map<std::array<std::int32_t, 2>, int> sides;
  for (const auto& t : mesh.triangles) {
    if (!gives_way(t, within)) continue;
    for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  }
  std::map<std::int32_t, std::int32_t> next;
  for (const auto& [side, count] : sides) {
    if (sides.contains({side[1], side[0]})) continue;
    if (count != 1 || within[side[0]] || !next.emplace(side[0], side[1]).second) return {};
  }
  std::vector<std::int32_t> ring;
  if (next.empty()) return ring;
  for (std::int32_t v = next.begin()->first; ring.empty() || v != ring.front(); v = next.at(v)) {
    if (!next.contains(v) || ring.size() == next.size()) return {};
    ring.push_back(v);
  }
  if (ring.size() != next.size()) return {};
  return ring;
}

/// Removes the marked vertices and their triangles; the others keep their order.
void remove(const std::vector<char>& within, FaceMesh& mesh, std::vector<std::int32_t>& ring) {
  std::erase_if(mesh.triangles, [&](const auto& t) { return gives_way(t, within); });
  std::vector<std::int32_t> number(mesh.points.size(), -1);
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (within[v]) continue;
    mesh.points[kept] = mesh.points[v], mesh.uv[kept] = mesh.uv[v];
    number[v] = kept++;
  }
  mesh.points.resize(kept), mesh.uv.resize(kept);
  for (auto& t : mesh.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  for (std::int32_t& v : ring) v = number[v];
  for (FaceMesh::ApexVertex& apex : mesh.apexes) apex.at = number[apex.at];
}

void cap(const Apex& apex, double size, FaceMesh& mesh) {
  const double around = std::max(least_around, std::round(apex.angle / (std::numbers::pi / 3)));
  double radius = around * size / apex.angle;
  for (int i = 0; i < most_disks; ++i, radius *= growth_of_disk) {
    const std::vector<char> within = vertices_within(mesh, apex.point, radius);
    if (within.empty()) return;
    std::vector<std::int32_t> ring = ring_around(mesh, within);
    if (ring.size() < 3) continue;
    remove(within, mesh, ring);
    const auto at = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.push_back(apex.point), mesh.uv.push_back(apex.uv);
    mesh.apexes.push_back({at, apex.vertex});
    for (std::size_t k = 0; k < ring.size(); ++k)
      mesh.triangles.push_back({at, ring[k], ring[(k + 1) % ring.size()]});
    return;
  }
}

/// Where a triangle lies, as its number and the corner at a vertex.
struct CornerOfTriangle {
  std::size_t triangle = 0;
  int corner = 0;
};

/// The triangle at a vertex that one alone uses.
std::optional<CornerOfTriangle> only_triangle_at(const FaceMesh& mesh, std::int32_t vertex) {
  std::optional<CornerOfTriangle> only;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles[t][k] != vertex) continue;
      if (only) return std::nullopt;
      only = {t, k};
    }
  }
  return only;
}

/// The triangle with this side, from `to` to `from`, and the corner opposite.
std::optional<CornerOfTriangle> triangle_behind(const FaceMesh& mesh, std::int32_t from, std::int32_t to) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto& triangle = mesh.triangles[t];
      if (triangle[(k + 1) % 3] == to && triangle[(k + 2) % 3] == from) return CornerOfTriangle{t, k};
    }
  }
  return std::nullopt;
}

/// Half-way between two vertices in the parameters of the face.
geometry::Vec2 middle_in_parameters(const cad::Model& model, const FaceMesh& mesh, std::int32_t a,
                                    std::int32_t b) {
  const geometry::Vec2 from = mesh.uv[a], period = model.parameter_periods(mesh.face, from);
  const geometry::Vec2 to = {unwrap(mesh.uv[b].x, from.x, period.x), unwrap(mesh.uv[b].y, from.y, period.y)};
  return model.wrap(mesh.face, 0.5 * (from + to));
}

void split_apex(const cad::Model& model, const cad::FaceCorner& corner, std::int32_t vertex, FaceMesh& mesh) {
  const auto at_apex = only_triangle_at(mesh, vertex);
  if (!at_apex) return;
  const auto filling = mesh.triangles[at_apex->triangle];
  const std::int32_t from = filling[(at_apex->corner + 1) % 3], to = filling[(at_apex->corner + 2) % 3];
  const auto behind = triangle_behind(mesh, from, to);
  constexpr double part_of_side = 0.5;
  const double near = part_of_side * distance(mesh.points[vertex], mesh.points[from]);
  if (!behind || !is_apex_of_two_faces(model, corner, near)) return;
  const std::int32_t opposite = mesh.triangles[behind->triangle][behind->corner];
  const geometry::Vec2 uv = middle_in_parameters(model, mesh, from, to);
  const auto middle = static_cast<std::int32_t>(mesh.points.size());
  mesh.points.push_back(model.face_point(mesh.face, uv)), mesh.uv.push_back(uv);
  mesh.triangles[at_apex->triangle] = {vertex, from, middle};
  mesh.triangles[behind->triangle] = {opposite, to, middle};
  mesh.triangles.push_back({vertex, middle, to});
  mesh.triangles.push_back({opposite, middle, from});
}

std::vector<Apex> apexes_at_poles(const cad::Model& model, const ChartSurface& surface) {
  std::vector<Apex> apexes;
  for (const auto& loop : model.face(surface.face).loops) {
    for (const cad::Coedge& use : loop) {
      const cad::Edge& edge = model.edge(use.edge);
      if (!edge.degenerate || surface.points.empty()) continue;
      const Vec3 place = model.vertex(edge.first);
      const std::int32_t point = nearest_point(surface.points, place);
      if (surface.mesh_vertex[point] >= 0) continue;
      const auto around = look_around(surface, point);
      if (!around || around->angle == 0 || around->angle >= widest_apex) continue;
      if (distance(surface.points[point], place) > same_place * around->reach) continue;
      const double middle = 0.5 * (edge.first_parameter + edge.last_parameter);
      apexes.push_back({edge.first, place, model.edge_uv(surface.face, use, middle), around->angle});
    }
  }
  return apexes;
}

/// Vertices of the facets inside of the face. What is wider is meshed across, as noise is.
std::vector<Apex> apexes_of_facets(const ChartSurface& surface) {
  std::vector<double> angles(surface.points.size(), 0);
  std::vector<geometry::Vec2> uv(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& v = surface.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = surface.points[v[k]];
      angles[v[k]] += angle_between(surface.points[v[(k + 1) % 3]] - p, surface.points[v[(k + 2) % 3]] - p);
      uv[v[k]] = surface.corner_uv[t][k];
    }
  }
  for (const auto& edge : surface.loop_edges) angles[edge[0]] = angles[edge[1]] = widest_apex;
  std::vector<Apex> apexes;
  for (std::size_t v = 0; v < angles.size(); ++v) {
    if (angles[v] > 0 && angles[v] < widest_apex_of_facets)
      apexes.push_back({cad::no_entity, surface.points[v], uv[v], angles[v]});
  }
  return apexes;
}

}  // namespace

void split_apexes_of_two_faces(const cad::Model& model, const FaceVertices& vertices, FaceMesh& mesh) {
  for (const cad::FaceCorner& corner : cad::corners_of(model, mesh.face)) {
    if (face_beyond_both_edges(model, corner) == cad::no_entity) continue;
    const mesh::SharedVertexKey key = mesh::cad_vertex_key(corner.vertex);
    if (std::binary_search(vertices.vertex_keys.begin(), vertices.vertex_keys.end(), key))
      split_apex(model, corner, vertices.find(key), mesh);
  }
}

std::vector<Apex> find_apexes(const cad::Model& model, const ChartSurface& surface) {
  return model.is_faceted(surface.face) ? apexes_of_facets(surface) : apexes_at_poles(model, surface);
}

void cap_apexes(const sizing::SizeField& field, const std::vector<Apex>& apexes, FaceMesh& mesh) {
  for (const Apex& apex : apexes) cap(apex, field(apex.point), mesh);
}

}  // namespace aeroloom::surface
