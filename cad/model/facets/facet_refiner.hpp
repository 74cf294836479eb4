/// Implementation of refine_facets(): linked triangles, their errors, and operations on them. For
/// facet_refinement.cpp and facet_refiner_topology.cpp only.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/predicates.hpp"

#include <array>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace aeroloom::cad {

/// A segment of a boundary line between two nodes.
struct BoundarySide {
  std::int32_t line;
  double low, high;  // parameters on the edge
  std::int32_t low_node, high_node;
  std::int32_t triangle = -1;
  int corner = -1;  // of the triangle, opposite the side
};

/// Refines the facets of one face in place.
class FacetRefiner {
public:
  FacetRefiner(const Model& model, FaceId id, double deflection, double angle, Facets& facets);
  void run();

private:
  using Triangle = std::array<std::int32_t, 3>;
  bool improve_once();

  /// If the triangle is flat, removes a vertex that is nearly collinear with others; otherwise divides the
  /// triangle.
  bool repair(std::int32_t t);
  bool alive(std::int32_t t) const { return _facets.triangles[t][0] >= 0; }
  std::int32_t count() const { return static_cast<std::int32_t>(_facets.triangles.size()); }
  Vec3 point(std::int32_t node) const { return _facets.points[node]; }
  Vec2 uv(std::int32_t node) const { return _facets.uv[node]; }

  /// Along du x dv, for either orientation of the face. Zero where it is undefined.
  Vec3 normal_at(Vec2 uv) const;

  // --- topology. A link is the triangle across a side, or ~index of a boundary side.

  void collect_sides();
  std::int32_t add_side(const BoundarySide& side);
  void link_triangles();
  std::int32_t corner(std::int32_t t, int i) const { return _facets.triangles[t][i % 3]; }

  void attach_side(std::int32_t side, std::int32_t t, int i);

  /// Sets the link of a side, in both directions.
  void attach(std::int32_t t, int i, std::int32_t link);
  int corner_opposite(std::int32_t t, std::int32_t a, std::int32_t b) const;
  bool positive(std::int32_t a, std::int32_t b, std::int32_t c) const;

  /// Triangles at a pole are not changed. The middle of their sides in parameters is far from the middle in
  /// space.
  bool touches_pole(std::int32_t t) const;
  bool is_pole(std::int32_t node) const { return _pole[node] != 0; }

  // --- geometry

  bool collapsed(std::int32_t t) const;

  /// 1 - cos of the largest angle between the triangle and the surface's normals at its corners.
  double error(std::int32_t a, std::int32_t b, std::int32_t c) const;
  double error(std::int32_t t) const { return error(corner(t, 0), corner(t, 1), corner(t, 2)); }

  int longest_side(std::int32_t t) const;
  double side_length(std::int32_t t, int i) const;
  bool is_bad(std::int32_t t) const;
  /// As is_bad(), but a triangle found good is not tested again until its corners change.
  bool has_become_bad(std::int32_t t);
  bool is_flat(std::int32_t t) const;

  /// A boundary side that is nearly the longest of the triangle. It is divided first, so that vertices do not
  /// crowd along it.
  std::int32_t encroached_side(std::int32_t t) const;
  std::int32_t add_node(Vec2 at, Vec3 place);

  // --- division

  bool split_longest(std::int32_t t);
  bool split_inside(std::int32_t t, int i);
  std::int32_t add_triangle(const Triangle& triangle);

  /// The other use of this segment by the same face (a seam); -1 if there is none.
  std::int32_t partner(const BoundarySide& side) const;
  bool split_boundary(std::int32_t s);
  Vec2 middle_uv(const BoundarySide& side) const;
  bool can_divide(std::int32_t s) const;
  void divide(std::int32_t s);

  // --- contraction

  /// The triangles around an interior vertex, counter-clockwise from t. Empty at the boundary.
  std::vector<std::int32_t> ring(std::int32_t t, std::int32_t vertex) const;
  int index_of(std::int32_t t, std::int32_t vertex) const;

  /// Contracts an edge of the triangle. Tries the vertex opposite the longest side first, and the nearer
  /// neighbour first.
  bool contract(std::int32_t t);
  bool contract(const std::vector<std::int32_t>& around, std::int32_t from, std::int32_t to);

  /// Whether the contraction would put two triangles on top of each other.
  bool pinches(const std::vector<std::int32_t>& moved, std::int32_t from, std::int32_t to) const;

  /// Removes a triangle that has the contracted side, and links its two neighbours.
  void take_out(std::int32_t t, std::int32_t from, std::int32_t to);

  // --- reconnection

  void push_sides(std::int32_t t);
  void flip();
  bool should_flip(std::int32_t t, int i) const;
  void flip(std::int32_t t, int i);
  void store_lines();
  struct StackedSide {
    std::int32_t from, to, triangle;
  };
  static constexpr std::int32_t no_link = std::numeric_limits<std::int32_t>::min();
  /// Over the deflection. Corners that are nearer coincide, as at poles and cusps.
  static constexpr double collapsed_side = 1e-6;
  const Model& _model;
  FaceId _id;
  Facets& _facets;
  double _deflection, _error_limit;
  std::size_t _most_triangles;
  std::vector<Vec3> _normals;
  std::vector<char> _pole;                          // per node
  std::vector<std::array<std::int32_t, 3>> _links;  // across the side opposite each corner
  std::vector<BoundarySide> _sides;
  std::map<std::pair<std::int32_t, double>, std::int32_t> _side_at;  // by line and lower parameter
  std::vector<StackedSide> _stack;
  std::vector<Triangle> _good;  // corners of each triangle when it was last found good
};

}  // namespace aeroloom::cad
