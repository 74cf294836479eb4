/// SU2 meshes: text (.su2) and binary (.su2b), with the markers' conditions beside them.
///
/// Text after SU2's documentation (docs_v7, `Mesh File`): NDIME, NPOIN, NELEM, NMARK in this order, shortest
/// decimal numbers that read back the same. Binary after SU2's own reader (CSU2BinaryMeshReaderBase): one
/// zone; 32-bit integers where points and connectivity fit them, else 64-bit; little-endian; names of markers
/// in 33 bytes. Both have the points in the order of their numbers; tetrahedra, pyramids and prisms, each in
/// the order of parts; a marker for each patch that bounds the mesh, triangles first. Corners are in VTK's
/// order and faces point into the fluid: SU2 turns none of them (CPhysicalGeometry:
/// Check_IntElem_Orientation, Check_BoundElem_Orientation). Conditions go to NAME_markers.cfg
/// (io/su2/su2_markers.hpp). Left out: parts, regions and their interfaces; a zone of SU2 is a mesh of its
/// own.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// The bytes depend on the parts alone; text is made twice, to know its length, and never held. Collective;
/// throws CollectiveError (files) where it cannot be written.
void write_su2(const FileMesh& mesh, const std::string& path);
void write_su2b(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
