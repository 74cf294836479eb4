/// Joins points of several files that have equal coordinates.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Gives all points with the same bits of all three coordinates the lowest of their ids. Cells and faces get
/// the new ids. The points of a rank must have consecutive ids, and its cells and faces must use no others.
/// Collective; the result does not depend on the number of ranks.
void join_equal_points(RawMesh& raw);

}  // namespace aeroloom::io
