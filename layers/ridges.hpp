/// Ridges: sharp convex edges of a wall, seen from their vertices.
#pragma once

#include "layers/star_triangle.hpp"

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// Least turn of a ridge, in radians: between the normals of both triangles at an edge of which nothing is
/// known, and somewhere along a sharp CAD edge, whose other edges need turn by the least alone.
inline constexpr double sharp_turn = std::numbers::pi / 3, least_turn = std::numbers::pi / 36;

/// The edges of ridges at a vertex, which part the triangles around it into sides. A ridge passes with two
/// edges, or ends with one on a plane that layers end on; three and more meet in a corner. A ridge that lies
/// in such a plane is half of one: it passes, the plane's triangles are one of its sides, and the direction
/// over it bisects the wall and its mirror image.
struct Ridge {
  struct Edge {
    mesh::VertexName end;       ///< its other vertex
    TrianglePlace right, left;  ///< seen from the fluid and from the vertex
    geometry::Vec3 direction;   ///< unit, from the vertex
  };
  /// How directions turn over an edge, from its left to its right through the fluid.
  struct Turn {
    geometry::Vec3 normal, across;  ///< unit vectors: the first direction, and the one it turns towards
    double angle = 0;               ///< in radians
    geometry::Vec3 direction(double at) const;
  };
  std::vector<Edge> edges;            ///< counter-clockwise
  std::vector<geometry::Vec3> sides;  ///< unit mean normals; side i lies on the left of edge i
  std::vector<Turn> turns;            ///< by edge; of a ridge that passes or ends on a plane, the one of both
  /// Of a ridge that passes: column c is longer by (c . mitre) mitre, so that it is as high seen along both
  /// edges.
  geometry::Vec3 mitre;
  geometry::Vec3 plane;  ///< unit normal, where the ridge ends on a plane
  double cone = 1;       ///< least cosine of the angle between a side's mean normal and the normals there
  TrianglePlace lowest;  ///< of the star
  bool on_plane = false;
  std::int32_t half_side = -1;  ///< of a ridge in a plane: the side that is the plane's, else -1
  std::int32_t plane_face = -1, plane_patch = -1;  ///< CAD face and patch
  TrianglePlace last_of_plane;                     ///< the plane's triangle beside the second side
  mesh::VertexName rim;                            ///< the other vertex of that edge

  bool is_corner() const { return edges.size() > 2; }
  /// The side on the right of an edge.
  std::size_t right_of(std::size_t edge) const { return (edge + sides.size() - 1) % sides.size(); }
};

/// By triangle of a star: the side it is of.
using RidgeSide = std::uint8_t;
inline constexpr RidgeSide side_of_plane = 255;

/// The vertex of a star, over whose CAD edge the surface is not smooth.
struct StarCentre {
  geometry::Vec3 point;
  EdgeTurn turn;
  geometry::Vec3 plane;  ///< normal of the plane there that layers end on, or zero
};

/// The ridges at a vertex, and by triangle of the star its side. Nothing where no edge is sharp, one ends off
/// planes, or sides have no direction. The star is closed and in order, counter-clockwise seen from the
/// fluid.
std::optional<Ridge> find_ridge(const StarCentre& centre, std::span<const StarTriangle> star,
                                std::vector<RidgeSide>& sides);

}  // namespace aeroloom::layers
