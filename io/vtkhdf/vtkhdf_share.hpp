/// One rank's share of a VTKHDF file.
#pragma once

#include "io/raw_mesh.hpp"
#include "io/vtkhdf/vtkhdf_survey.hpp"

namespace aeroloom::io::vtkhdf {

/// Reads the share of a rank. In `grid`, cells and the faces among them have places among the points of all
/// partitions for corners, and points their ids; in `boundary`, the faces of /Boundary have ids. Regions and
/// patches are the values of the file. Throws std::runtime_error with the file and the place. Not collective.
void read_share(const FileFacts& facts, RawMesh& grid, RawMesh& boundary);

}  // namespace aeroloom::io::vtkhdf
