/// Planes that layers end on.
#pragma once

#include "layers/columns.hpp"

#include <span>
#include <vector>

namespace aeroloom::layers {

/// By CAD face of a surface mesh: the unit normal out of the fluid where layers end on the face, else zero.
/// These are the planar faces of patches of symmetry, slip, inlet or outlet without layers, if options say
/// so. Faces whose vertices agree in all bits of a coordinate have exact normals. Collective, the same on
/// every rank.
std::vector<geometry::Vec3> find_end_planes(const mesh::DistributedMesh& mesh, const LayerOptions& options);

/// The part of a direction along planes with these normals, one or two: of two, along their line. Where a
/// normal points along an axis, that component is -0: adding any multiple of it leaves all bits of a
/// coordinate.
geometry::Vec3 along_planes(geometry::Vec3 direction, std::span<const geometry::Vec3> normals);

}  // namespace aeroloom::layers
