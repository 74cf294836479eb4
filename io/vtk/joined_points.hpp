/// Points of several files that are one because they are in one place.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Gives points whose three coordinates have equal bits the lowest of their ids, and cells and faces with
/// them. The ids of a share's points must be consecutive, and its cells and faces use no others. Collective;
/// the same for any number of ranks.
void join_equal_points(RawMesh& raw);

}  // namespace aeroloom::io
