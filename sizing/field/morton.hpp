/// The grid of octrees under the names it has here.
#pragma once

#include "geometry/morton.hpp"

namespace aeroloom::sizing {

using geometry::finest_level;
using geometry::grid_point;
using geometry::grid_size;
using geometry::GridPoint;
using geometry::morton_key;

}  // namespace aeroloom::sizing
