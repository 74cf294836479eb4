#include "geometry/unite_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

namespace aeroloom::geometry {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Mesh::Face_index;
using Sources = Mesh::Property_map<Face, TriangleSource>;

Sources sources_of(Mesh& mesh) {
  return mesh.add_property_map<Face, TriangleSource>("f:source").first;  // that which is there, or a new one
}

/// Tells every face that is made which triangle it lies in.
struct SourceVisitor : pmp::Corefinement::Default_visitor<Mesh> {
  TriangleSource divided;

  void before_subface_creations(Face face, Mesh& mesh) { divided = sources_of(mesh)[face]; }
  void after_subface_created(Face face, Mesh& mesh) { sources_of(mesh)[face] = divided; }
  void after_face_copy(Face from, const Mesh& source, Face to, Mesh& target) {
    sources_of(target)[to] = source.property_map<Face, TriangleSource>("f:source").first[from];
  }
};

void fill_mesh(const ClosedSurface& surface, std::int32_t number, Mesh& mesh) {
  std::vector<Kernel::Point_3> points;
  points.reserve(surface.points.size());
  for (const Vec3 p : surface.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles)
    triangles.push_back(
        {static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  // Points at which a surface touches itself are doubled; triangles stay in order.
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) pmp::orient_polygon_soup(points, triangles);
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  Sources sources = sources_of(mesh);
  std::int32_t triangle = 0;
  for (const Face face : mesh.faces()) sources[face] = {number, triangle++};
}

Vec3 rounded(const Kernel::Point_3& p) {
  const auto& exact = CGAL::exact(p);
  return {CGAL::to_double(exact.x()), CGAL::to_double(exact.y()), CGAL::to_double(exact.z())};
}

/// What a mesh encloses, seen from a place near it.
double volume_of(const Mesh& mesh, Vec3 middle) {
  double sum = 0;
  for (const Face face : mesh.faces()) {
    Vec3 corners[3];
    int i = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      corners[i++] = rounded(mesh.point(vertex)) - middle;
    sum += dot(corners[0], cross(corners[1], corners[2])) / 6;
  }
  return sum;
}

std::string volumes_text(double first, double second, double common, double united) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "parts of volumes %.9g and %.9g that share %.9g gave a union of volume %.9g", first, second,
                common, united);
  return text;
}

/// All that one step needs, in one place: the library's results depend on the order of addresses of meshes.
struct UnionStep {
  std::array<Mesh, 2> parts;
  Mesh united, common;
};

/// Why the step's union is none; empty where it is sound.
std::string unite_parts(UnionStep& step, Vec3 middle, double volume_tolerance) {
  auto& [first, second] = step.parts;
  const double before[2] = {volume_of(first, middle), volume_of(second, middle)};
  sources_of(step.united), sources_of(step.common);
  std::array<boost::optional<Mesh*>, 4> outputs;
  outputs[pmp::Corefinement::UNION] = &step.united;
  outputs[pmp::Corefinement::INTERSECTION] = &step.common;
  const auto parameters = CGAL::parameters::visitor(SourceVisitor()).throw_on_self_intersection(true);
  const auto done = pmp::corefine_and_compute_boolean_operations(first, second, outputs, parameters);
  if (!done[pmp::Corefinement::UNION]) return "they touch along a line or at a point";
  if (!done[pmp::Corefinement::INTERSECTION])
    return "what they share touches itself along a line or at a point";
  const double common = volume_of(step.common, middle), united = volume_of(step.united, middle);
  if (std::abs(before[0] + before[1] - common - united) > volume_tolerance * (before[0] + before[1]))
    return volumes_text(before[0], before[1], common, united);
  return {};
}

/// A mesh as plain data, in an order of its own: points by coordinates, triangles by source.
UnitedSurface extract(const Mesh& mesh) {
  struct Corner {
    Vec3 at;
    std::size_t vertex;
  };
  std::vector<Corner> corners;
  for (const auto vertex : mesh.vertices())
    corners.push_back({rounded(mesh.point(vertex)), static_cast<std::size_t>(vertex)});
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.at.x, a.at.y, a.at.z, a.vertex) < std::tie(b.at.x, b.at.y, b.at.z, b.vertex);
  });
  std::vector<std::int32_t> number(corners.size() + mesh.number_of_removed_vertices());
  UnitedSurface result;
  for (const Corner& corner : corners) {
    number[corner.vertex] = static_cast<std::int32_t>(result.surface.points.size());
    result.surface.points.push_back(corner.at);
  }
  const Sources sources = mesh.property_map<Face, TriangleSource>("f:source").first;
  std::vector<std::pair<TriangleSource, TriangleCorners>> triangles;
  for (const Face face : mesh.faces()) {
    TriangleCorners triangle{};
    int i = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      triangle[i++] = number[static_cast<std::size_t>(vertex)];
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    triangles.emplace_back(sources[face], triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  for (const auto& [source, triangle] : triangles) {
    result.sources.push_back(source);
    result.surface.triangles.push_back(triangle);
  }
  return result;
}

void require_volume(const Mesh& mesh, std::size_t surface) {
  if (CGAL::is_closed(mesh) && pmp::does_bound_a_volume(mesh)) return;
  throw UnionError(surface, "its triangles bound no volume");
}

}  // namespace

UnitedSurface unite_surfaces(const std::vector<ClosedSurface>& surfaces, double volume_tolerance) {
  Box box;
  for (const ClosedSurface& surface : surfaces) {
    for (const Vec3 p : surface.points) box.add(p);
  }
  const Vec3 middle = box.center();
  auto step = std::make_unique<UnionStep>();
  fill_mesh(surfaces.front(), 0, step->parts[0]);
  require_volume(step->parts[0], 0);
  for (std::size_t i = 1; i < surfaces.size(); ++i) {
    fill_mesh(surfaces[i], static_cast<std::int32_t>(i), step->parts[1]);
    require_volume(step->parts[1], i);
    std::string fault;
    try {
      fault = unite_parts(*step, middle, volume_tolerance);
    } catch (const std::exception&) {
      // What the library says are lines of its sources; it means that a part is not as it should be.
      fault = "the triangles of one of them cross each other there";
    }
    if (!fault.empty()) throw UnionError(i, fault);
    auto next = std::make_unique<UnionStep>();
    next->parts[0] = step->united;
    step = std::move(next);
  }
  return extract(step->parts[0]);
}

}  // namespace aeroloom::geometry
