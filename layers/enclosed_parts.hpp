/// Finds parts of the boundary that lie inside the layers of another part.
#pragma once

#include "layers/fans.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// The triangles of this rank whose layers contain the test point of a CAD face, unless it is one of their
/// corners. A cap without intersections may enclose a whole part of the boundary. All faces of that part are
/// then inside, so one point per face is tested. Says nothing where the cap intersects the part. `ends`:
/// upper ends of the columns, by column. Collective.
std::vector<std::int32_t> find_enclosing_triangles(const LocalWall& wall, const Fans& fans,
                                                   const std::vector<geometry::Vec3>& ends);

}  // namespace aeroloom::layers
