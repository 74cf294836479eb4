/// Writes a decomposed OpenFOAM case: CASE/processorN/constant/polyMesh for each part. As many ranks can run
/// it without decomposePar. A mesh of one part becomes CASE/constant/polyMesh.
///
/// Files: points, faces, owner, neighbour, boundary. Several regions become cellZones. Interior patches
/// become faceZones, with normals from the front region to the back region. Several parts have cell-, face-,
/// point- and boundaryProcAddressing for reconstructPar. Every part has all patches in the same order, also
/// empty ones, and then processor patches. Types: wall -> wall, symmetry -> symmetry, all others -> patch.
/// Each patch is in the group (inGroups) with the name of its type. Names become different words: letters,
/// digits, _ - . and bytes beyond ASCII stay, others become _. system/controlDict, fvSchemes, fvSolution and
/// decomposeParDict are written only where they are missing. Format: binary headers as OpenFOAM writes them,
/// https://doc.cfd.direct/openfoam/user-guide-v11/mesh-description.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

struct OpenFoamOptions {
  bool binary = true;
  /// Bits of labels in binary files: 32, 64, or 0: 32 where all numbers of the mesh fit. Builds of OpenFOAM
  /// since v1912 read both widths; those of the Foundation need WM_LABEL_SIZE to match.
  int label_bits = 0;
};

/// Writes the case `folder`, and removes meshes of earlier runs there. No mesh stays half written. A rank
/// holds the face order of one part at a time. Collective. Throws CollectiveError: (files) with the path,
/// also where surplus processor folders hold results; (input) where the mesh has open faces.
void write_openfoam(const FileMesh& mesh, const std::string& folder, const OpenFoamOptions& options = {});

/// The command that scales a mesh in a case; with `-parallel` where that has parts.
std::string openfoam_scaling(double factor);

/// The bits of labels: 32, or 64 where a count of the mesh or of the face corners of a part needs them.
int foam_label_bits(mesh::GlobalIndex cells, mesh::GlobalIndex faces, mesh::GlobalIndex points,
                    mesh::GlobalIndex corners_of_part);

}  // namespace aeroloom::io
