#include "pipeline/interfaces.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/schedule.hpp"
#include "surface/curve_metric.hpp"
#include "surface/front.hpp"
#include "surface/triangle_patch.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;

/// Vertices inside the straight edges, by edge.
struct EdgePoints {
  std::vector<std::int32_t> first;  // (edges + 1)
  std::vector<Vec3> points;
};

bool is_trace(const InterfaceEdge& edge) {
  return edge.last_path > edge.first_path;
}

/// Equal steps in the metric of the field.
std::vector<Vec3> divide(Vec3 a, Vec3 b, const sizing::SizeField& field) {
  const double length = distance(a, b);
  const surface::MetricLength metric([&](double t) { return length / field((1 - t) * a + t * b); }, {0, 1});
  const int segments = std::max(1, static_cast<int>(std::lround(metric.total())));
  std::vector<Vec3> points;
  for (const double t : surface::equal_parts(metric, segments)) points.push_back((1 - t) * a + t * b);
  return points;
}

EdgePoints divide_edges(const parallel::Communicator& communicator, const VolumePlan& plan,
                        const sizing::SizeField& field, parallel::StageClock& clock) {
  struct Row {
    std::int32_t edge, count;
  };
  std::vector<Row> rows;
  std::vector<Vec3> points;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (std::size_t e = communicator.rank(); e < plan.edges.size(); e += communicator.size()) {
      const InterfaceEdge& edge = plan.edges[e];
      if (is_trace(edge)) continue;
      const std::vector<Vec3> inner =
          divide(plan.vertices[edge.from].point, plan.vertices[edge.to].point, field);
      rows.push_back({static_cast<std::int32_t>(e), static_cast<std::int32_t>(inner.size())});
      points.insert(points.end(), inner.begin(), inner.end());
    }
  }
  const std::vector<Row> all_rows = communicator.all_gather_items<Row>(rows);
  const std::vector<Vec3> all_points = communicator.all_gather_items<Vec3>(points);
  EdgePoints result;
  result.first.assign(plan.edges.size() + 1, 0);
  for (const Row& row : all_rows) result.first[row.edge + 1] = row.count;
  for (std::size_t e = 0; e < plan.edges.size(); ++e) result.first[e + 1] += result.first[e];
  result.points.resize(all_points.size());
  std::size_t next = 0;
  for (const Row& row : all_rows) {
    for (std::int32_t i = 0; i < row.count; ++i)
      result.points[result.first[row.edge] + i] = all_points[next++];
  }
  return result;
}

class FaceMesher {
public:
  FaceMesher(const VolumePlan& plan, const EdgePoints& edges, GlobalIndex surface_vertices,
             const sizing::SizeField& field)
      : _plan(plan), _edges(edges), _field(field), _vertices(plan.vertices) {
    GlobalIndex next = surface_vertices;
    for (BoundaryPoint& vertex : _vertices) {
      if (vertex.number < 0) vertex.number = next++;
    }
    _first_edge_number = next;
  }

  GlobalIndex first_inner_number() const {
    return _first_edge_number + static_cast<GlobalIndex>(_edges.points.size());
  }

  /// The rim of a background triangle and its filling; inner vertices are numbered from 0 on.
  void mesh(std::int32_t f, InterfaceMesh& result) const {
    const InterfaceFace& face = _plan.faces[f];
    std::array<surface::PatchSide, 3> sides;
    std::vector<BoundaryPoint> rim;
    for (int k = 0; k < 3; ++k) {
      std::vector<BoundaryPoint> side = side_of(face, k);
      sides[k].straight = !is_trace(_plan.edges[face.edges[k]]);
      for (const BoundaryPoint& v : side) sides[k].points.push_back(v.point);
      rim.insert(rim.end(), side.begin(), side.end() - 1);
    }
    const surface::PatchMesh patch = surface::fill_triangle(sides, [&](Vec3 p) { return _field(p); });
    const auto number = [&](std::int32_t v) {
      const auto on_rim = static_cast<std::int32_t>(rim.size());
      return v < on_rim ? rim[v].number : -1 - GlobalIndex{v - on_rim};
    };
    for (const auto& t : patch.triangles)
      result.triangles.push_back({{number(t[0]), number(t[1]), number(t[2])}, f});
    result.vertices.insert(result.vertices.end(), rim.begin(), rim.end());
    for (std::size_t i = 0; i < patch.inner.size(); ++i)
      result.vertices.push_back(
          {-1 - static_cast<GlobalIndex>(i), patch.inner[i], 3, _plan.region_of[face.part]});
    result.faces.push_back(f);
    result.first_triangle.push_back(static_cast<std::int32_t>(result.triangles.size()));
    result.first_vertex.push_back(static_cast<std::int32_t>(result.vertices.size()));
  }

private:
  /// The vertices from corner k to the next one.
  std::vector<BoundaryPoint> side_of(const InterfaceFace& face, int k) const {
    const std::int32_t e = face.edges[k];
    const InterfaceEdge& edge = _plan.edges[e];
    const mesh::RegionId region = _plan.region_of[face.part];
    std::vector<BoundaryPoint> side;
    if (is_trace(edge)) {
      for (std::int32_t i = edge.first_path; i < edge.last_path; ++i) side.push_back(_plan.path[i]);
    } else {
      side.push_back(_vertices[edge.from]);
      for (std::int32_t i = _edges.first[e]; i < _edges.first[e + 1]; ++i)
        side.push_back({_first_edge_number + i, _edges.points[i], 3, region});
      side.push_back(_vertices[edge.to]);
    }
    if (edge.from != face.vertices[k]) std::reverse(side.begin(), side.end());
    return side;
  }

  const VolumePlan& _plan;
  const EdgePoints& _edges;
  const sizing::SizeField& _field;
  std::vector<BoundaryPoint> _vertices;  // of the plan, numbered
  GlobalIndex _first_edge_number = 0;
};

/// What meshing a background triangle costs, about: the fine triangles it gets.
std::vector<double> face_loads(const VolumePlan& plan, const sizing::SizeField& field) {
  std::vector<double> loads;
  for (const InterfaceFace& face : plan.faces) {
    const Vec3 a = plan.vertices[face.vertices[0]].point, b = plan.vertices[face.vertices[1]].point,
               c = plan.vertices[face.vertices[2]].point;
    const double h = field((a + b + c) / 3.0);
    loads.push_back(1 + norm(cross(b - a, c - a)) / (h * h));
  }
  return loads;
}

/// Gives inner vertices their numbers: face by face, whichever rank has meshed it.
void number_inner(const parallel::Communicator& communicator, const VolumePlan& plan,
                  GlobalIndex first_number, InterfaceMesh& mesh) {
  struct Row {
    std::int32_t face, count;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    std::int32_t count = 0;
    for (std::int32_t v = mesh.first_vertex[i]; v < mesh.first_vertex[i + 1]; ++v)
      count += mesh.vertices[v].number < 0;
    rows.push_back({mesh.faces[i], count});
  }
  std::vector<GlobalIndex> first(plan.faces.size() + 1, 0);
  for (const Row& row : communicator.all_gather_items<Row>(rows)) first[row.face + 1] = row.count;
  first[0] = first_number;
  for (std::size_t f = 0; f < plan.faces.size(); ++f) first[f + 1] += first[f];
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const GlobalIndex start = first[mesh.faces[i]];
    for (std::int32_t v = mesh.first_vertex[i]; v < mesh.first_vertex[i + 1]; ++v) {
      GlobalIndex& number = mesh.vertices[v].number;
      if (number < 0) number = start - 1 - number;
    }
    for (std::int32_t t = mesh.first_triangle[i]; t < mesh.first_triangle[i + 1]; ++t) {
      for (GlobalIndex& number : mesh.triangles[t].vertices) {
        if (number < 0) number = start - 1 - number;
      }
    }
  }
}

}  // namespace

InterfaceMesh mesh_interfaces(const parallel::Communicator& communicator, const VolumePlan& plan,
                              GlobalIndex surface_vertices, const sizing::SizeField& field,
                              parallel::StageClock& clock) {
  const EdgePoints edges = divide_edges(communicator, plan, field, clock);
  const FaceMesher mesher(plan, edges, surface_vertices, field);
  const std::vector<double> loads = face_loads(plan, field);
  const std::vector<parallel::Rank> owners = parallel::assign_largest_first(loads, communicator.size());
  InterfaceMesh result;
  result.first_triangle.push_back(0);
  result.first_vertex.push_back(0);
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (std::size_t f = 0; f < plan.faces.size(); ++f) {
      if (owners[f] != communicator.rank()) continue;
      try {
        mesher.mesh(static_cast<std::int32_t>(f), result);
      } catch (const surface::FrontError&) {
        result.failed.push_back(static_cast<std::int32_t>(f));
      }
    }
  });
  result.failed = communicator.all_gather_items<std::int32_t>(result.failed);
  std::sort(result.failed.begin(), result.failed.end());
  number_inner(communicator, plan, mesher.first_inner_number(), result);
  result.triangle_count = communicator.sum(static_cast<std::int64_t>(result.triangles.size()));
  return result;
}

}  // namespace aeroloom::pipeline
