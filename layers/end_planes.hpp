/// Planes that boundary layers end on.
#pragma once

#include "layers/columns.hpp"

#include <span>
#include <vector>

namespace aeroloom::layers {

/// By CAD face of a surface mesh: the unit normal out of the fluid if layers end on the face, else zero.
/// Layers end on planar faces without layers of symmetry, slip, inlet and outlet patches, if the options
/// allow it. If all vertices of a face have the same bits in a coordinate, its normal is exact. Collective;
/// equal on all ranks.
std::vector<geometry::Vec3> find_end_planes(const mesh::DistributedMesh& mesh, const LayerOptions& options);

/// The part of a direction parallel to one plane, or to the intersection line of two, given by normals. If a
/// normal is exactly along an axis, that component is -0: adding a multiple of it keeps a coordinate bit for
/// bit.
geometry::Vec3 along_planes(geometry::Vec3 direction, std::span<const geometry::Vec3> normals);

}  // namespace aeroloom::layers
