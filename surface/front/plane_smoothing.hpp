/// Smooths a plane triangulation: moves its free vertices so that triangles become more equilateral.
#pragma once

#include "surface/front/delaunay.hpp"

#include <cstdint>

namespace aeroloom::front {

/// Moves the vertices from `first_free` on, in sweeps. After each sweep flips make the mesh Delaunay again.
/// No move folds a triangle.
void smooth_plane(Delaunay& plane, std::int32_t first_free, int sweeps);

}  // namespace aeroloom::front
