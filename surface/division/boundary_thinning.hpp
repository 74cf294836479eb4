/// Taking vertices off the boundary of a chart surface.
#pragma once

#include "cad/model/model.hpp"
#include "surface/charts/chart_surface.hpp"

#include <vector>

namespace aeroloom::surface {

/// Contracts boundary points of the chart surface that are mesh vertices to be dropped (`keep` per mesh
/// vertex is 0) into the kept ones before them on their loop, where that folds no triangle; those that have
/// to stay are no mesh vertices any more. `mesh_vertex` and `loop_edges` are kept up; numbers of vertices
/// stay.
void drop_boundary_vertices(const cad::Model& model, const std::vector<char>& keep, ChartSurface& surface);

}  // namespace aeroloom::surface
