/// Writes a case of OpenFOAM, decomposed: CASE/processorN/constant/polyMesh, one for each part, to be run by
/// as many ranks without decomposePar. A mesh of one part becomes CASE/constant/polyMesh.
///
/// Written: points, faces, owner, neighbour, boundary; cellZones by region where there are several; faceZones
/// of interior patches, their normals from the front region to that beyond; for several parts cell-, face-,
/// point- and boundaryProcAddressing with numbers of the whole mesh (for reconstructPar). All patches stand
/// in each part in the same order, empty ones too; then processor patches. Types: wall -> wall, symmetry ->
/// symmetry, all others -> patch; each patch is in the group (inGroups) of its type's name, which fields may
/// use. Names become words: letters, digits, _ - . and bytes beyond ASCII stay, all else becomes _; distinct.
/// system/controlDict, fvSchemes, fvSolution and decomposeParDict are written only where there are none.
/// Format: https://doc.cfd.direct/openfoam/user-guide-v11/mesh-description, binary headers as OpenFOAM writes
/// them.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

struct OpenFoamOptions {
  bool binary = true;
  /// Width of labels in binary files: 32, 64, or 0: 32 where all numbers of the mesh fit. Releases since
  /// v1912 read either width in a build of the other; the Foundation's need WM_LABEL_SIZE to match.
  int label_bits = 0;
};

/// `folder`: of the case. Meshes of an earlier run in it go. Throws CollectiveError: files with the path,
/// also where processor folders beyond the parts hold results; input where faces of the mesh are open.
/// Nothing stays half written. A rank holds the face order of one part at a time. Collective.
void write_openfoam(const FileMesh& mesh, const std::string& folder, const OpenFoamOptions& options = {});

/// What a user has to do where lengths of the mesh are in another unit, which is so many metres.
std::string openfoam_unit_warning(const std::string& unit, double in_metres);

/// 32, or 64 where a number of the mesh, or of the corners of faces of one part, needs it.
int foam_label_bits(mesh::GlobalIndex cells, mesh::GlobalIndex faces, mesh::GlobalIndex points,
                    mesh::GlobalIndex corners_of_part);

}  // namespace aeroloom::io
