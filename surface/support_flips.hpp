/// Delaunay flips of a support.
#pragma once

#include "surface/support.hpp"

namespace aeroloom::surface {

/// Flips edges between nearly coplanar triangles until the angles opposite each sum to no more than 180
/// degrees. A flip keeps boundary and uv consistent: it is not made across a seam, nor where it would fold
/// space or parameter plane.
void flip_to_delaunay(Support& support);

}  // namespace aeroloom::surface
