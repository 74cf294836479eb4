/// All that host programs need of the improvement stage. It changes a tetrahedral mesh by local operations
/// until no dihedral angle misses the target, or nothing more is gained.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "improve/improver.hpp"
#include "improve/mesh_source.hpp"
