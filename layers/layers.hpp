/// All that host programs need of the boundary-layer stage. The stage grows columns of nodes on the walls of
/// a surface mesh. Once the volume outside their cap is filled, it makes prisms, pyramids and tetrahedra from
/// them.
#pragma once

#include "layers/columns.hpp"
#include "layers/layer_cells.hpp"
