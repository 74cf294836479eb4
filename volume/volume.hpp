/// All that host programs need of the volume stage. From a closed surface mesh and a size field it divides
/// space into zones, and fills them with tetrahedra that are the same on any number of ranks.
#pragma once

#include "volume/volume_failure.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_report.hpp"
