/// The local operations of remesh_interior() on the mesh of one face.
#pragma once

#include "geometry/triangle_links.hpp"
#include "surface/remesh/remesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::surface {

/// The worst values over a set of triangles.
struct TriangleShapes {
  double mean_ratio = 1;  ///< smallest
  /// Smallest signed squared cosine between the normal of a triangle and the mean normal of the surface at
  /// its vertices.
  double facing = 1;
  double energy = 0;  ///< sum of inverse mean ratios
  void add(const TriangleShapes& other) {
    mean_ratio = std::min(mean_ratio, other.mean_ratio);
    facing = std::min(facing, other.facing);
    energy += other.energy;
  }
};

/// The mesh of a face while it is changed. Each operation visits all places that changed in the last sweep.
class FaceRemesher {
public:
  FaceRemesher(const cad::Model& model, const sizing::SizeField& field, FaceMesh& mesh);

  void contract_short_edges();
  /// Stops at a number of vertices that follows from the sizes.
  void divide_long_edges();
  void flip_edges();
  void smooth();
  /// Moves vertices of triangles with an angle below 26 degrees to where the smallest angle around them is
  /// largest.
  void widen_sharp_triangles();
  /// One sweep of straighten_cuts().
  void straighten(const std::vector<std::int32_t>& part, double smallest_angle);
  /// Ends a sweep. The next one visits only places that this one changed.
  void end_sweep();
  /// Writes triangles and vertices back, without those that were removed.
  void finish();

private:
  /// The actual or a possible place of a vertex.
  struct VertexPlace {
    geometry::Vec3 point, normal;
    geometry::Vec2 uv;
    double size = 0;
  };

  /// An edge of the ring around a new vertex, which lies on its left, and the edge on its other side.
  struct StarEdge {
    std::int32_t origin, target;
    geometry::LinkedEdge outside;
  };

  void open_slits();
  void measure_vertices();
  geometry::Vec3 fan_normal(std::int32_t vertex);
  VertexPlace place_of(std::int32_t vertex) const;
  void put(std::int32_t vertex, const VertexPlace& place);
  /// The nearest place on the CAD surface. False where it is farther off than `most_distance`.
  bool project(geometry::Vec3 point, std::int32_t guess, double most_distance, VertexPlace& place) const;

  TriangleShapes shape(const std::array<VertexPlace, 3>& corners) const;
  TriangleShapes shape(std::int32_t triangle) const;
  TriangleShapes shape(std::int32_t a, std::int32_t b, std::int32_t c) const;
  /// The shape of the triangle after its corner at `vertex` has moved.
  TriangleShapes shape_with(std::int32_t triangle, std::int32_t vertex, const VertexPlace& moved) const;

  bool is_free(std::int32_t vertex) const { return _movable[vertex] != 0; }
  bool is_live(std::int32_t triangle) const { return _links.triangles[triangle].vertices[0] >= 0; }
  bool is_edge_active(geometry::LinkedEdge edge) const {
    return _active[_links.origin(edge)] || _active[_links.target(edge)];
  }
  double edge_length(geometry::LinkedEdge edge) const;
  double edge_size(geometry::LinkedEdge edge) const {
    return 0.5 * (_sizes[_links.origin(edge)] + _sizes[_links.target(edge)]);
  }
  void note_change(std::int32_t vertex);
  void note_fan();  // that was gathered last

  bool is_contraction_wanted(geometry::LinkedEdge edge) const;
  bool contract(geometry::LinkedEdge edge);
  bool try_contraction(geometry::LinkedEdge edge, const VertexPlace& place);
  bool keeps_topology(geometry::LinkedEdge edge);
  std::size_t bound_vertices() const;
  void divide(geometry::LinkedEdge edge);
  void plan_star(geometry::LinkedEdge edge, const VertexPlace& middle, TriangleShapes& before,
                 TriangleShapes& after);
  bool flip_if_better(geometry::LinkedEdge edge);
  double smallest_sine(std::int32_t a, std::int32_t b, std::int32_t c) const;
  geometry::Vec3 ideal_place(std::int32_t vertex) const;
  void smooth_vertex(std::int32_t vertex);
  std::optional<double> judge_fan(const std::vector<double>& before) const;
  bool widen_vertex(std::int32_t vertex);
  /// Collects the other ends of the borders at a vertex, counter-clockwise. Borders are edges between parts,
  /// and edges of one triangle.
  void gather_borders(std::int32_t vertex, const std::vector<std::int32_t>& part);
  double smallest_border_angle(std::int32_t vertex, const std::vector<std::int32_t>& part);
  bool straighten_vertex(std::int32_t vertex, const std::vector<std::int32_t>& part, double smallest_angle);

  const cad::Model& _model;
  const sizing::SizeField& _field;
  FaceMesh& _mesh;
  geometry::TriangleLinks _links;
  std::vector<geometry::Vec3> _normals;      // per vertex, of the surface
  std::vector<double> _sizes;                // per vertex
  std::vector<std::uint8_t> _movable;        // per vertex
  std::vector<std::uint8_t> _active, _next;  // per vertex: looked at in this sweep, in the next
  std::size_t _most_vertices;                // nothing is divided then
  std::vector<std::int32_t> _fan, _other_fan, _borders;
  std::vector<double> _fan_sines;
  std::vector<geometry::LinkedEdge> _stack;
  std::vector<StarEdge> _star, _replaced;
};

/// A triangle may deviate from the surface by 45 degrees (squared cosine). If it deviates more already, that
/// must not get worse.
inline constexpr double least_facing = 0.5;

/// Whether a change is allowed: no triangle folds, and the worst shape does not get worse unless it is still
/// good.
bool is_acceptable(const TriangleShapes& before, const TriangleShapes& after);

}  // namespace aeroloom::surface
