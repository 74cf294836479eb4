/// Ridges: sharp convex edges of a wall, seen from their vertices.
#pragma once

#include "layers/star_triangle.hpp"

#include <array>
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
/// edges, or ends with one on a plane that layers end on; three and more meet in a corner.
struct Ridge {
  struct Edge {
    mesh::VertexName end;       ///< its other vertex
    TrianglePlace right, left;  ///< seen from the fluid and from the vertex
    geometry::Vec3 direction;   ///< unit, from the vertex
    bool is_rim;                ///< the free rim of a baffle
    bool is_path;               ///< of a path, where the ridge itself has ended
  };
  /// How directions turn over an edge, from its left to its right through the fluid.
  struct Turn {
    geometry::Vec3 normal, across;  ///< unit vectors: the first direction, and the one it turns towards
    double angle = 0;               ///< in radians
    geometry::Vec3 direction(double at) const;
    /// About the same bisector.
    Turn widened(double least_angle) const;
  };
  std::vector<Edge> edges;            ///< counter-clockwise
  std::vector<geometry::Vec3> sides;  ///< unit mean normals; side i lies on the left of edge i
  std::vector<Turn> turns;            ///< by edge; of a ridge that passes or ends on a plane, the one of both
  /// Of a ridge that passes: column c is longer by (c . mitre) mitre, so that it is as high seen along both
  /// edges.
  geometry::Vec3 mitre;
  /// Where a ridge goes over to a path: tangents of the angles by which the outer columns lean along it.
  std::array<double, 2> ahead{};
  geometry::Vec3 plane;  ///< unit normal, where the ridge ends on a plane
  double cone = 1;       ///< least cosine of the angle between a side's mean normal and the normals there
  TrianglePlace lowest;  ///< of the star
  bool on_plane = false;
  std::int32_t plane_face = -1, plane_patch = -1;  ///< CAD face and patch
  TrianglePlace last_of_plane;                     ///< the plane's triangle beside the second side
  mesh::VertexName rim;                            ///< the other vertex of that edge
  double path_turn = 0;                            ///< where an edge is of a path: PathEdge::turn
  std::int32_t joint = -1;  ///< where a path ends at a ridge that passes: its place among the edges

  bool is_corner() const { return edges.size() > 2 && joint < 0; }
  bool is_on_path() const { return path_turn > 0; }
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
  geometry::Vec3 plane;             ///< normal of the plane there that layers end on, or zero
  std::span<const PathEdge> paths;  ///< those from the vertex
};

/// What is known of the ridges at a vertex.
struct RidgeSearch {
  std::optional<Ridge> ridge;
  bool is_lost = false;                  ///< sharp edges meet, but have no ridge
  std::optional<mesh::VertexName> open;  ///< lost, for a ridge ends off planes: the other vertex of its edge
};

/// The ridges at a vertex, and by triangle of the star its side. They are lost where one ends off planes,
/// runs beside a strip, or sides have no direction; free rims of baffles alone are not. The star is closed
/// and in order, counter-clockwise seen from the fluid.
RidgeSearch find_ridge(const StarCentre& centre, std::span<const StarTriangle> star,
                       std::vector<RidgeSide>& sides);

}  // namespace aeroloom::layers
