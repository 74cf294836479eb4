/// Writes SU2 meshes: text (.su2) and binary (.su2b), with the conditions of markers in a file beside them.
///
/// Text follows SU2's documentation (docs_v7, `Mesh File`): NDIME, NPOIN, NELEM, NMARK in this order. Numbers
/// have the fewest digits that read back the same. Binary follows SU2's reader (CSU2BinaryMeshReaderBase):
/// one zone, little-endian, names of markers in 33 bytes. Integers have 32 bits, or 64 bits where points or
/// connectivity need them. Points come by number; cells come by part and shape. Each patch on
/// the boundary is a marker, with triangles first. Corners have VTK's order, and faces point into the fluid;
/// SU2 then reorients none (CPhysicalGeometry: Check_IntElem_Orientation, Check_BoundElem_Orientation).
/// Conditions go to NAME_markers.cfg (io/su2/su2_markers.hpp). Left out: parts, regions, and the faces
/// between regions, because each zone of SU2 is a mesh of its own.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// The bytes depend on the parts alone. Text is formatted twice, first to know its length, and never held in
/// memory. Collective; throws CollectiveError (files) where the file cannot be written.
void write_su2(const FileMesh& mesh, const std::string& path);
void write_su2b(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
