/// From boundary loops to a constrained Delaunay triangulation whose triangles know whether they are inside.
#pragma once

#include "surface/front/delaunay.hpp"
#include "surface/front/front.hpp"

namespace aeroloom::front {

/// The state of a triangle in the front, kept in the user's bits of its flags.
enum class TriangleState : std::uint32_t { outside = 0, waiting = 1, accepted = 2 };

inline TriangleState state_of(const geometry::LinkedTriangle& triangle) {
  return static_cast<TriangleState>(triangle.flags >> 6);
}
inline void set_state(geometry::LinkedTriangle& triangle, TriangleState state) {
  triangle.flags = (triangle.flags & 0b111111u) | static_cast<std::uint32_t>(state) << 6;
}

/// Triangulates the boundary with all its edges fixed; triangles left of the edges wait, the others are
/// outside. Throws FrontError.
Delaunay triangulate_region(const FrontInput& boundary);

}  // namespace aeroloom::front
