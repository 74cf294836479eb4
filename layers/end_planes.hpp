/// Planes and curved faces that boundary layers end on.
#pragma once

#include "layers/columns.hpp"
#include "mesh/exchange/shared_vertices.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// Whether layers may end on the planes of patches of this type.
constexpr bool may_end_on(mesh::PatchType type) {
  using mesh::PatchType;
  return type == PatchType::symmetry || type == PatchType::slip || type == PatchType::inlet ||
         type == PatchType::outlet;
}

/// By CAD face of a surface mesh: the unit normal out of the fluid if layers end on the face, else zero.
/// Layers end on planar faces without layers of symmetry, slip, inlet and outlet patches, if the options
/// allow it. If all vertices of a face have the same bits in a coordinate, its normal is exact. Collective;
/// equal on all ranks.
std::vector<geometry::Vec3> find_end_planes(const mesh::DistributedMesh& mesh, const LayerOptions& options);

/// By CAD face: 1 where layers end on a face that is none of the planes, else 0. They end on faces without
/// layers of the same types, and on far fields, where a wall with layers meets them; on none without
/// LayerOptions::curved_ends. Collective; equal on all ranks.
std::vector<std::uint8_t> find_curved_ends(const mesh::DistributedMesh& mesh, const LayerOptions& options,
                                           const std::vector<geometry::Vec3>& planes,
                                           const mesh::SharedVertices& shared);

/// The part of a direction parallel to one plane, or to the intersection line of two, given by normals. If a
/// normal is exactly along an axis, that component is -0: adding a multiple of it keeps a coordinate bit for
/// bit.
geometry::Vec3 along_planes(geometry::Vec3 direction, std::span<const geometry::Vec3> normals);

}  // namespace aeroloom::layers
