/// CGNS in HDF5, as most solvers and committees of the field read it.
///
/// Follows the SIDS 3.4 and its file mapping (cgns.github.io): nodes as its library stores them in HDF5.
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Writes `path` (MESH.cgns): one base, one unstructured zone, vertices in the order of the mesh in double
/// precision. A section of TETRA_4, PYRA_5 or PENTA_6 per region and shape, called as the region (with the
/// shape after it, REGION_TETRA_4, where there are several); after them a section of TRI_3 or QUAD_4 per
/// patch and shape, counter-clockwise seen from outside, called as the patch (PATCH_TRI_3 and PATCH_QUAD_4
/// where it has both); for each patch a BC_t FamilySpecified over its elements and a family with the
/// condition: wall BCWallViscous, slip BCWallInviscid, symmetry BCSymmetryPlane, farfield BCFarfield, inlet
/// BCInflow, outlet BCOutflow. Names that CGNS cannot hold change as NodeNames says (cgns_names.hpp); a
/// Descriptor_t FullName keeps the whole. Indices have 32 bits where all fit, otherwise 64, in all nodes.
///
/// Left out: parts, faces between regions (one zone has no place for them), patches without faces, the unit
/// of length (it says UserDefined). Collective; throws CollectiveError (files) where it cannot be written.
/// The bytes depend on the parts alone.
void write_cgns(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
