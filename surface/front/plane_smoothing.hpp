/// Moves the free vertices of a plane triangulation to where its triangles get closer to equilateral.
#pragma once

#include "surface/front/delaunay.hpp"

#include <cstdint>

namespace aeroloom::front {

/// Sweeps over the vertices from `first_free` on, each followed by flips that make the mesh Delaunay again. A
/// vertex moves only where that folds nothing.
void smooth_plane(Delaunay& plane, std::int32_t first_free, int sweeps);

}  // namespace aeroloom::front
