#include "surface/pointed_tips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace aeroloom::surface {

namespace {

using geometry::Vec3;

constexpr double widest_tip = 340 * std::numbers::pi / 180;
/// Sizes that fit around a tip at the ring of its fan, at least: with three the fan has no inside.
constexpr double least_around = 4;
/// The disk that gives way grows by this factor, so often, until it is one.
constexpr double growth_of_disk = 1.3;
constexpr int most_disks = 5;

double angle_between(Vec3 a, Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Angles of the support's triangles around a point, together; nothing on the border.
std::optional<double> angle_around(const Support& support, std::int32_t point) {
  const auto uses = [&](const auto& edge) { return edge[0] == point || edge[1] == point; };
  if (std::any_of(support.loop_edges.begin(), support.loop_edges.end(), uses)) return std::nullopt;
  double angle = 0;
  for (const auto& t : support.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] != point) continue;
      const Vec3 p = support.points[point];
      angle += angle_between(support.points[t[(k + 1) % 3]] - p, support.points[t[(k + 2) % 3]] - p);
    }
  }
  if (angle == 0) return std::nullopt;
  return angle;
}

std::int32_t nearest_point(const std::vector<Vec3>& points, Vec3 place) {
  const auto nearer = [&](Vec3 a, Vec3 b) { return distance(a, place) < distance(b, place); };
  return static_cast<std::int32_t>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

/// Vertices next to each vertex.
std::vector<std::vector<std::int32_t>> neighbours_of(const FaceMesh& mesh) {
  std::vector<std::vector<std::int32_t>> neighbours(mesh.points.size());
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours[t[k]].push_back(t[(k + 1) % 3]);
      neighbours[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  return neighbours;
}

/// By vertex: whether it gives way. Those nearer than `radius` that hang together with the nearest of all;
/// empty where a border vertex is among them.
std::vector<char> vertices_within(const FaceMesh& mesh, Vec3 place, double radius) {
  const auto neighbours = neighbours_of(mesh);
  std::vector<char> within(mesh.points.size(), 0);
  std::vector<std::int32_t> open = {nearest_point(mesh.points, place)};
  within[open.front()] = 1;
  while (!open.empty()) {
    const std::int32_t v = open.back();
    open.pop_back();
    if (v < mesh.fixed) return {};
    for (const std::int32_t next : neighbours[v]) {
      if (within[next] || distance(mesh.points[next], place) >= radius) continue;
      within[next] = 1;
      open.push_back(next);
    }
  }
  return within;
}

bool gives_way(const std::array<std::int32_t, 3>& triangle, const std::vector<char>& within) {
  return within[triangle[0]] || within[triangle[1]] || within[triangle[2]];
}

/// The border of the triangles that give way, one loop; nothing where they have another.
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

/// Takes the vertices that give way out, and their triangles; the others keep their order.
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
  for (FaceMesh::Tip& tip : mesh.tips) tip.at = number[tip.at];
}

void cap(const PointedTip& tip, double size, FaceMesh& mesh) {
  const double around = std::max(least_around, std::round(tip.angle / (std::numbers::pi / 3)));
  double radius = around * size / tip.angle;
  for (int i = 0; i < most_disks; ++i, radius *= growth_of_disk) {
    const std::vector<char> within = vertices_within(mesh, tip.point, radius);
    if (within.empty()) return;
    std::vector<std::int32_t> ring = ring_around(mesh, within);
    if (ring.size() < 3) continue;
    remove(within, mesh, ring);
    const auto at = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.push_back(tip.point), mesh.uv.push_back(tip.uv);
    mesh.tips.push_back({at, tip.vertex});
    for (std::size_t k = 0; k < ring.size(); ++k)
      mesh.triangles.push_back({at, ring[k], ring[(k + 1) % ring.size()]});
    return;
  }
}

}  // namespace

std::vector<PointedTip> find_pointed_tips(const cad::Model& model, const Support& support) {
  std::vector<PointedTip> tips;
  for (const auto& loop : model.face(support.face).loops) {
    for (const cad::Coedge& use : loop) {
      const cad::Edge& edge = model.edge(use.edge);
      if (!edge.degenerate || support.points.empty()) continue;
      const Vec3 place = model.vertex(edge.first);
      const std::int32_t point = nearest_point(support.points, place);
      if (support.points[point] != place || support.mesh_vertex[point] >= 0) continue;
      const std::optional<double> angle = angle_around(support, point);
      if (!angle || *angle >= widest_tip) continue;
      const double middle = 0.5 * (edge.first_parameter + edge.last_parameter);
      tips.push_back({edge.first, place, model.edge_uv(support.face, use, middle), *angle});
    }
  }
  return tips;
}

void cap_pointed_tips(const sizing::SizeField& field, const std::vector<PointedTip>& tips, FaceMesh& mesh) {
  for (const PointedTip& tip : tips) cap(tip, field(tip.point), mesh);
}

}  // namespace aeroloom::surface
