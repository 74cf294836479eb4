/// All that host programs need of the stage of boundary layers. From a surface mesh it grows columns of nodes
/// on the walls, and turns them into prisms, pyramids and tetrahedra once the volume in cap of them is
/// filled.
#pragma once

#include "layers/columns.hpp"
#include "layers/layer_cells.hpp"
