/// Paths over the wall along which the sectors of ridges go on that end on it, as a wing's trailing edge ends
/// at a fuselage: a sector cannot end on a wall.
#pragma once

#include "layers/vertex_stars.hpp"

#include <vector>

namespace aeroloom::layers {

/// The paths of all ridges that end off planes: each from such an end to another, to a plane that layers end
/// on, or to a place where a ridge passes, its own included; the cheapest by length and bends within some
/// rings of triangles. Paths do not meet. Empty where one end has none, or where ridges have been lost for
/// other reasons. Equal on all ranks. Collective.
PathEdges find_ridge_paths(const LocalWall& wall, const VertexStars& stars);

}  // namespace aeroloom::layers
