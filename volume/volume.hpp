/// The volume stage for host programs. It divides the space inside a closed surface mesh into zones, and
/// fills them with tetrahedra of the sizes of a size field. The mesh is the same on any number of ranks.
#pragma once

#include "volume/volume_failure.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_report.hpp"
