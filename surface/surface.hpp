/// All that host programs need of the surface stage. From a model and a size field it makes a closed
/// triangulation of all CAD faces, and meshes planar faces again where boundary layers have moved their
/// boundaries.
#pragma once

#include "surface/plane_remesher.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_mesher.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"
