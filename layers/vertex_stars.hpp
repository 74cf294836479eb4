/// The triangles around each vertex of a wall, those of other pieces included.
#pragma once

#include "layers/local_wall.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// What keeps a column from a vertex, or nothing.
enum class StarKind : std::int8_t {
  plain,    ///< one closed star of triangles that ask for layers, or end them in a plane
  broken,   ///< several stars, an open one, or an edge of more than two triangles
  ending,   ///< a triangle where layers may not end, or three planes
  off_wall  ///< no triangle asks for layers
};

/// By vertex of the wall. Equal in all pieces that know it.
struct VertexStars {
  std::vector<StarKind> kinds;
  std::vector<std::int64_t> first;  ///< (vertices + 1)
  /// Unit, into the fluid, of layered triangles: by piece, then triangle. On planes that layers end on, their
  /// mirror images follow: so the most normal direction lies in the plane.
  std::vector<geometry::Vec3> normals;
  std::vector<std::int64_t> first_plane;  ///< (vertices + 1)
  std::vector<geometry::Vec3>
      plane_normals;  ///< of the planes through a vertex that layers end on: two at most

  std::span<const geometry::Vec3> normals_at(std::int32_t vertex) const {
    return std::span(normals).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
  std::span<const geometry::Vec3> planes_at(std::int32_t vertex) const {
    return std::span(plane_normals)
        .subspan(first_plane[vertex], first_plane[vertex + 1] - first_plane[vertex]);
  }
};

/// What pieces know of a shared vertex is brought together once. Collective.
VertexStars gather_stars(const LocalWall& wall);

}  // namespace aeroloom::layers
