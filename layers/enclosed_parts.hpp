/// Parts of the boundary that layers of another part have closed around.
#pragma once

#include "layers/local_wall.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// Triangles of this rank whose layers hold a point of a CAD face that is not theirs. A cap that meets
/// nothing can have a whole part behind it: then every face of that part is there, so one point of each face
/// tells. Where a cap meets a part, this says nothing. `ends`: of the columns, by vertex of the wall.
/// Collective.
std::vector<std::int32_t> find_enclosing_triangles(const LocalWall& wall,
                                                   const std::vector<geometry::Vec3>& ends);

}  // namespace aeroloom::layers
