/// The triangles around each vertex of a wall, those of other pieces included.
#pragma once

#include "layers/wall_share.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// What keeps a column from a vertex, or nothing.
enum class FanKind : std::int8_t {
  plain,    ///< one closed fan of triangles that ask for layers, or end them in a plane
  broken,   ///< several fans, an open one, or an edge of more than two triangles
  ending,   ///< a triangle where layers may not end
  off_wall  ///< no triangle asks for layers
};

/// By vertex of the wall. Equal in all pieces that know it.
struct Fans {
  std::vector<FanKind> kinds;
  std::vector<std::int64_t> first;  ///< (vertices + 1)
  std::vector<geometry::Vec3>
      normals;  ///< unit, into the fluid, of layered triangles: by piece, then triangle

  std::span<const geometry::Vec3> normals_at(std::int32_t vertex) const {
    return std::span(normals).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

/// What pieces know of a shared vertex is brought together once. Collective.
Fans gather_fans(const parallel::Communicator& communicator, const WallShare& wall);

}  // namespace aeroloom::layers
