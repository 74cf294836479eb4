#include "surface/charts/surface_topology.hpp"

#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <span>
#include <tuple>

namespace aeroloom::surface {
namespace {

/// One triangle being divided: corners, and the points still to insert on each of its edges.
struct Division {
  std::array<std::int32_t, 3> corner;
  std::array<geometry::Vec2, 3> uv;
  std::array<std::span<const EdgePoint>, 3> inserts;
};

/// Fans the first edge that has points from the opposite corner, and so on until no points are left.
void emit(const Division& division, ChartSurface& out) {
  int edge = 0;
  while (edge < 3 && division.inserts[edge].empty()) ++edge;
  if (edge == 3) {
    out.triangles.push_back(division.corner);
    out.corner_uv.push_back(division.uv);
    return;
  }
  const int after = (edge + 1) % 3, opposite = (edge + 2) % 3;
  const auto inserts = division.inserts[edge];
  const std::size_t last = inserts.size();
  for (std::size_t i = 0; i <= last; ++i) {
    Division part;
    part.corner = {i == 0 ? division.corner[edge] : inserts[i - 1].point,
                   i == last ? division.corner[after] : inserts[i].point, division.corner[opposite]};
    part.uv = {i == 0 ? division.uv[edge] : inserts[i - 1].uv, i == last ? division.uv[after] : inserts[i].uv,
               division.uv[opposite]};
    if (i == last) part.inserts[1] = division.inserts[after];
    if (i == 0) part.inserts[2] = division.inserts[opposite];
    emit(part, out);
  }
}

}  // namespace

std::vector<std::vector<geometry::HalfEdge>> trace_boundary(const ChartSurface& surface,
                                                            const std::vector<geometry::HalfEdge>& twins) {
  std::vector<geometry::HalfEdge> outgoing(surface.points.size(), -1);
  const geometry::HalfEdge count = static_cast<geometry::HalfEdge>(twins.size());
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    if (twins[h] < 0) outgoing[start_of(surface, h)] = h;
  }
  std::vector<std::vector<geometry::HalfEdge>> loops;
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    if (twins[h] >= 0 || outgoing[start_of(surface, h)] != h) continue;
    std::vector<geometry::HalfEdge> loop;
    for (geometry::HalfEdge at = h; at >= 0;) {
      loop.push_back(at);
      outgoing[start_of(surface, at)] = -1;
      at = outgoing[end_of(surface, at)];
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<std::array<std::int32_t, 2>> trace_loop_edges(const ChartSurface& surface) {
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const auto& loop : trace_boundary(surface, geometry::match_half_edges(surface.triangles))) {
    std::int32_t first = -1, last = -1;
    for (const geometry::HalfEdge h : loop) {
      const std::int32_t point = start_of(surface, h);
      if (surface.mesh_vertex[point] < 0) continue;
      if (first < 0) first = point;
      if (last >= 0) edges.push_back({last, point});
      last = point;
    }
    if (last >= 0) edges.push_back({last, first});
  }
  return edges;
}

std::vector<ChartSurface> separate_parts(const ChartSurface& surface,
                                         const std::vector<geometry::HalfEdge>& twins,
                                         const std::vector<std::int32_t>& part, std::int32_t parts) {
  // Corners joined across edges inside a part are one point of it.
  geometry::DisjointSets<std::int32_t> fans(3 * surface.triangles.size());
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    if (twins[h] < h || part[h / 3] != part[twins[h] / 3]) continue;
    fans.unite(h, geometry::next_half_edge(twins[h]));
    fans.unite(geometry::next_half_edge(h), twins[h]);
  }
  std::vector<ChartSurface> result(parts);
  std::vector<std::int32_t> number(3 * surface.triangles.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (part[t] < 0) continue;
    ChartSurface& out = result[part[t]];
    std::array<std::int32_t, 3> triangle;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t root = fans.root(static_cast<std::int32_t>(3 * t + i));
      if (number[root] < 0) {
        number[root] = static_cast<std::int32_t>(out.points.size());
        out.points.push_back(surface.points[surface.triangles[t][i]]);
        out.mesh_vertex.push_back(surface.mesh_vertex[surface.triangles[t][i]]);
      }
      triangle[i] = number[root];
    }
    out.triangles.push_back(triangle);
    out.corner_uv.push_back(surface.corner_uv[t]);
  }
  for (ChartSurface& out : result) {
    out.face = surface.face;
    out.loop_edges = trace_loop_edges(out);
  }
  return result;
}

std::int32_t label_components(const std::vector<geometry::HalfEdge>& twins,
                              const std::vector<std::int32_t>& label, std::vector<std::int32_t>& component) {
  component.assign(label.size(), -1);
  std::int32_t count = 0;
  std::vector<std::int32_t> stack;
  for (std::size_t seed = 0; seed < label.size(); ++seed) {
    if (component[seed] >= 0) continue;
    component[seed] = count;
    stack.push_back(static_cast<std::int32_t>(seed));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const geometry::HalfEdge twin = twins[3 * t + i];
        if (twin < 0 || component[twin / 3] >= 0 || label[twin / 3] != label[t]) continue;
        component[twin / 3] = count;
        stack.push_back(twin / 3);
      }
    }
    ++count;
  }
  return count;
}

bool is_planar_domain(const ChartSurface& surface) {
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(surface.triangles);
  const auto boundary_edges = std::count(twins.begin(), twins.end(), -1);
  const auto edges = (static_cast<std::int64_t>(twins.size()) + boundary_edges) / 2;
  const auto euler = static_cast<std::int64_t>(surface.points.size()) - edges +
                     static_cast<std::int64_t>(surface.triangles.size());
  const auto loops = static_cast<std::int64_t>(trace_boundary(surface, twins).size());
  return loops >= 1 && euler == 2 - loops;
}

std::vector<std::int32_t> divide_edges(ChartSurface& surface, std::vector<EdgePoint> points) {
  std::sort(points.begin(), points.end(), [](const EdgePoint& a, const EdgePoint& b) {
    return std::tie(a.half_edge, a.fraction, a.point) < std::tie(b.half_edge, b.fraction, b.point);
  });
  ChartSurface divided;
  std::vector<std::int32_t> former;
  std::size_t at = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Division division{surface.triangles[t], surface.corner_uv[t], {}};
    for (int i = 0; i < 3; ++i) {
      const std::size_t begin = at;
      while (at < points.size() && points[at].half_edge == static_cast<geometry::HalfEdge>(3 * t + i)) ++at;
      division.inserts[i] = std::span<const EdgePoint>(points).subspan(begin, at - begin);
    }
    emit(division, divided);
    former.resize(divided.triangles.size(), static_cast<std::int32_t>(t));
  }
  surface.triangles = std::move(divided.triangles);
  surface.corner_uv = std::move(divided.corner_uv);
  return former;
}

geometry::Vec3 area_vector(const ChartSurface& surface, std::int32_t triangle) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return 0.5 * geometry::cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]);
}

double surface_area(const ChartSurface& surface) {
  double area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    area += geometry::norm(area_vector(surface, static_cast<std::int32_t>(t)));
  return area;
}

std::vector<std::array<std::int32_t, 2>> slits_of(const ChartSurface& surface) {
  std::vector<std::array<std::int32_t, 2>> used, slits;
  for (const auto& [from, to] : surface.loop_edges)
    used.push_back({surface.mesh_vertex[from], surface.mesh_vertex[to]});
  std::sort(used.begin(), used.end());
  for (const auto& [a, b] : used)
    if (a < b && std::binary_search(used.begin(), used.end(), std::array{b, a})) slits.push_back({a, b});
  slits.erase(std::unique(slits.begin(), slits.end()), slits.end());
  return slits;
}

}  // namespace aeroloom::surface
