/// Reads the items of one rank from a VTKHDF file.
#pragma once

#include "io/raw_mesh.hpp"
#include "io/vtkhdf/vtkhdf_survey.hpp"

namespace aeroloom::io::vtkhdf {

/// Reads the range of this rank. In `grid` points have ids, but corners of cells and faces are indices among
/// the points of all partitions. In `boundary` corners of the faces of /Boundary are ids. Regions and patches
/// are the values in the file. Throws std::runtime_error with the file and the place. Not collective.
void read_local_items(const FileFacts& facts, RawMesh& grid, RawMesh& boundary);

}  // namespace aeroloom::io::vtkhdf
