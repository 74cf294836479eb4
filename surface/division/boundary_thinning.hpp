/// Removes vertices from the boundary of a parametric triangulation.
#pragma once

#include "cad/model/model.hpp"
#include "surface/charts/chart_surface.hpp"

#include <vector>

namespace aeroloom::surface {

/// Removes boundary vertices with `keep` 0 (per mesh vertex). Each is contracted into the point before it on
/// its loop, unless a triangle would fold. A point that cannot be contracted stays, but is no mesh vertex any
/// more. `mesh_vertex` and `loop_edges` are updated; vertices keep their numbers.
void drop_boundary_vertices(const cad::Model& model, const std::vector<char>& keep, ChartSurface& surface);

}  // namespace aeroloom::surface
