/// The star of each wall vertex: all triangles around it, those of other pieces included.
#pragma once

#include "layers/curved_ends.hpp"
#include "layers/ridges.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// Whether a star allows a column, and if not, why.
enum class StarKind : std::int8_t {
  plain,    ///< one closed fan of triangles with layers or on planes that layers end on
  broken,   ///< several fans, an open one, or an edge of more than two triangles
  ending,   ///< a triangle does not let layers end on it, or three planes meet
  off_wall  ///< no triangle has requested layers
};

/// By vertex of the wall. Equal in all pieces with a vertex.
struct VertexStars {
  std::vector<StarKind> kinds;
  std::vector<std::int64_t> first;  ///< (vertices + 1)
  /// Unit normals, into the fluid, of the triangles with layers: by piece, then triangle. On planes that
  /// layers end on, their mirror images follow. So the most normal direction lies in the plane.
  std::vector<geometry::Vec3> normals;
  std::vector<std::int64_t> first_plane;  ///< (vertices + 1)
  std::vector<geometry::Vec3>
      plane_normals;  ///< of the planes at a vertex that layers end on, or EndPlace::across; at most two

  EndPlaces ends;

  std::vector<Ridge> ridges;
  std::vector<std::int32_t> ridge_of;  ///< by vertex: its ridge, or -1
  std::vector<RidgeSide> sides;        ///< by triangle and corner: the side of the ridge there

  const Ridge* ridge_at(std::int32_t vertex) const {
    return ridge_of[vertex] < 0 ? nullptr : &ridges[ridge_of[vertex]];
  }
  std::span<const geometry::Vec3> normals_at(std::int32_t vertex) const {
    return std::span(normals).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
  std::span<const geometry::Vec3> planes_at(std::int32_t vertex) const {
    return std::span(plane_normals)
        .subspan(first_plane[vertex], first_plane[vertex + 1] - first_plane[vertex]);
  }
};

/// Collects the stars, with triangles of other pieces. Collective.
VertexStars gather_stars(const LocalWall& wall);

}  // namespace aeroloom::layers
