/// Constrained Delaunay triangulation of boundary loops, with each triangle marked as inside or outside.
#pragma once

#include "surface/front/delaunay.hpp"
#include "surface/front/front.hpp"

namespace aeroloom::front {

/// The state of a triangle in the advancing front. It is kept in the user bits of LinkedTriangle::flags.
enum class TriangleState : std::uint32_t { outside = 0, waiting = 1, accepted = 2 };

inline TriangleState state_of(const geometry::LinkedTriangle& triangle) {
  return static_cast<TriangleState>(triangle.flags >> 6);
}
inline void set_state(geometry::LinkedTriangle& triangle, TriangleState state) {
  triangle.flags = (triangle.flags & 0b111111u) | static_cast<std::uint32_t>(state) << 6;
}

/// Triangulates the boundary with all its edges fixed. Triangles left of the edges are waiting, all others
/// outside. Throws FrontError.
Delaunay triangulate_region(const FrontInput& boundary);

}  // namespace aeroloom::front
