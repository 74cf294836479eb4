/// UGRID files with their .mapbc, which FUN3D, refine, Flow360 and USM3D read.
///
/// PATH tells the kind (io/ugrid/ugrid_format.hpp): .lb8.ugrid, .b8.ugrid, or .lb8l.ugrid, .b8l.ugrid with
/// 64-bit integers. Written: points in the order of their numbers; tetrahedra, pyramids and prisms, each in
/// the order of parts; the faces of all patches that bound the mesh, triangles, then quadrilaterals, each
/// sorted by patch id, pointing into the fluid. Ids are 1 .. N in the order of patches that have faces.
/// NAME.mapbc beside it lists id, FUN3D's number of the condition and name (blanks and `/ , ; * ' "` become
/// `_`; later ones of equal names get `_2`, ...). A plane of symmetry is normal to an axis where it extends
/// less than 1e-9 of its size along it. Left out: parts, regions and their interfaces, for which UGRID has no
/// place.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// The bytes depend on the parts alone. Collective; throws CollectiveError: input where the name has no UGRID
/// suffix or the mesh does not fit its integers, files where it cannot be written.
void write_ugrid(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
