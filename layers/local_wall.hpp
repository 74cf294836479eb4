/// The wall mesh on this rank: all its local pieces in flat arrays.
#pragma once

#include "layers/columns.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/exchange/shared_vertices.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// A triangle by piece and number in it.
struct TrianglePlace {
  mesh::PieceId piece = -1;
  mesh::LocalIndex cell = -1;
  friend auto operator<=>(const TrianglePlace&, const TrianglePlace&) = default;
};

/// What a triangle means for the columns at its corners.
enum class WallRole : std::int8_t {
  layered,  ///< layers are requested
  plane,    ///< of a plane or a curved face that layers end on
  other     ///< layers may not end here
};

/// The local pieces, one after another. Vertex v of piece p has the number first_vertex[p] + v; triangles
/// alike. A vertex of several pieces has a number in each, with equal values.
struct LocalWall {
  using Corners = std::array<std::int32_t, 3>;

  /// Keeps a reference to the mesh. Throws CollectiveError if the options do not fit it. Collective.
  LocalWall(const mesh::DistributedMesh& mesh, const LayerOptions& options);

  std::int32_t vertex_count() const { return static_cast<std::int32_t>(points.size()); }
  std::int32_t triangle_count() const { return static_cast<std::int32_t>(triangles.size()); }
  std::span<const std::int32_t> triangles_around(std::int32_t vertex) const {
    return std::span(around).subspan(first_around[vertex], first_around[vertex + 1] - first_around[vertex]);
  }
  /// Of all vertices: what each is called in every piece.
  std::vector<mesh::VertexName> vertex_names() const;
  /// The piece and the number in it of a triangle.
  TrianglePlace place_of(std::int32_t triangle) const;
  /// Which corner of a triangle a vertex is: 0 to 2.
  std::size_t corner_of(std::int32_t triangle, std::int32_t vertex) const {
    const Corners& corners = triangles[triangle];
    return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
  }
  bool is_curved_end(std::int32_t face) const { return curved_ends[face] != 0; }
  /// How the surface turns over the CAD edge of a vertex of a piece at a position; smooth within faces.
  EdgeTurn turn_at(std::size_t position, mesh::LocalIndex vertex) const;
  /// Calls visit(neighbour) for the other corners of the layered triangles around a vertex; most come twice.
  template <class Visit>
  void for_each_neighbour(std::int32_t vertex, const Visit& visit) const {
    for (const std::int32_t t : triangles_around(vertex)) {
      if (roles[t] != WallRole::layered) continue;
      for (const std::int32_t corner : triangles[t]) {
        if (corner != vertex) visit(corner);
      }
    }
  }

  /// Replaces the values of a vertex in all pieces by their combination in the order of pieces. Collective.
  template <parallel::Flat T, class Op>
  void combine(std::vector<T>& values, const Op& op) const {
    std::vector<T> copies = values_of_copies(values);
    shared.reduce_and_scatter(copies, op);
    for (std::size_t c = 0; c < copies.size(); ++c) values[vertex_of_copy[c]] = copies[c];
  }
  /// Replaces the values of a vertex in all pieces by that of the lowest piece. Collective.
  template <parallel::Flat T>
  void spread(std::vector<T>& values) const {
    std::vector<T> copies = values_of_copies(values);
    shared.scatter(copies);
    for (std::size_t c = 0; c < copies.size(); ++c) values[vertex_of_copy[c]] = copies[c];
  }

  const mesh::DistributedMesh& mesh;
  std::vector<std::int32_t> first_vertex{0}, first_triangle{0};  ///< by piece; the totals come last
  std::vector<geometry::Vec3> points;
  std::vector<Corners> triangles;            ///< counter-clockwise seen from the fluid, opposite to the mesh
  std::vector<std::int32_t> patches, faces;  ///< by triangle; CAD faces
  std::vector<WallRole> roles;
  std::vector<EdgeTurn> edges;             ///< LayerOptions::edges
  std::vector<geometry::Vec3> end_planes;  ///< by CAD face: normals of planes that layers end on, else zero
  std::vector<std::uint8_t> curved_ends;   ///< by CAD face: 1 on curved ones that layers end on
  std::shared_ptr<const CurvedEnds> ends;  ///< LayerOptions::curved_ends
  std::vector<std::int32_t> first_around,
      around;  ///< triangles by vertex, ascending; each list ends where the next begins
  mesh::SharedVertices shared;
  std::vector<std::int32_t> vertex_of_copy;
  std::vector<std::uint8_t> owned;  ///< 1: no lower piece has the vertex

private:
  template <class T>
  std::vector<T> values_of_copies(const std::vector<T>& values) const {
    std::vector<T> copies(vertex_of_copy.size());
    for (std::size_t c = 0; c < copies.size(); ++c) copies[c] = values[vertex_of_copy[c]];
    return copies;
  }
};

}  // namespace aeroloom::layers
