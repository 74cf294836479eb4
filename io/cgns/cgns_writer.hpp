/// Writes CGNS files in HDF5, which most solvers of the field read.
///
/// The file follows SIDS 3.4 and its HDF5 mapping (cgns.github.io), with the nodes as the CGNS library makes
/// them.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Writes `path` (MESH.cgns): one base and one unstructured zone. Vertices keep the order of the mesh, in
/// double precision. Each region has a section of TETRA_4, PYRA_5 or PENTA_6 for each of its shapes. The
/// section has the name of the region, or REGION_TETRA_4 and so on where the region has several shapes.
/// Sections TRI_3 or QUAD_4 of the patches follow (PATCH_TRI_3 and PATCH_QUAD_4 where a patch has both).
/// Their faces are counter-clockwise seen from outside. Each patch has a BC_t FamilySpecified over its
/// elements, and a family with the condition: wall BCWallViscous, slip BCWallInviscid, symmetry
/// BCSymmetryPlane, farfield BCFarfield, inlet BCInflow, outlet BCOutflow. NodeNames (cgns_names.hpp)
/// shortens names; a Descriptor_t FullName keeps the whole name. All indices have 32 bits, or all 64 where
/// needed.
///
/// Left out: parts, faces between regions (they have no place in one zone), empty patches, and the unit of
/// length (the file says UserDefined). Collective. Throws CollectiveError (files) where the file cannot be
/// written. The bytes depend on the parts of the mesh alone.
void write_cgns(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
