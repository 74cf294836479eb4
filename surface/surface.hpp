/// All headers of the surface stage for host programs. From a model and a size field it makes a closed
/// triangulation of all CAD faces. It also remeshes planar faces whose boundaries were moved by boundary
/// layers.
#pragma once

#include "surface/plane_remesher.hpp"
#include "surface/surface_error.hpp"
#include "surface/surface_mesher.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"
