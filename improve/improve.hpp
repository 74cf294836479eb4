/// All that host programs need of the improvement stage. The stage changes a tetrahedral mesh by local
/// operations until all dihedral angles meet the target, or no operation gains anything.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "improve/improver.hpp"
#include "improve/mesh_source.hpp"
