/// UGRID files: .lb8.ugrid, .b8.ugrid, .lb8l.ugrid, .b8l.ugrid, .lb8.ugrid64, .b8.ugrid64.
///
/// Every rank reads its share of points, faces and cells at offsets of its own. Patches are the ids that
/// faces have, ascending; NAME.mapbc beside NAME.lb8.ugrid, where there is one with the same ids, gives names
/// and conditions (one with others is left alone, with a warning), else a patch is called `patch_<id>` and a
/// wall. Names that come twice get `_<id>` after them. What may follow the cells (AFLR's optional records)
/// is left out. One region, `fluid`.
#pragma once

#include "io/raw_mesh.hpp"
namespace aeroloom::io {

/// Collective; throws CollectiveError naming the file and the byte, or line of the .mapbc: input where it
/// does not hold what its counts announce, for hexahedra, numbers of points out of range, coordinates that
/// are no numbers; files where it cannot be read.
RawMesh read_ugrid(const SharedPath& file);

}  // namespace aeroloom::io
