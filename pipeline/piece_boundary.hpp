/// From surface and interfaces to the closed boundaries of volume pieces: the step that joins the surface and
/// the volume stage, which know nothing of each other.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "pipeline/interfaces.hpp"
#include "pipeline/volume_plan.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// The closed boundary of one piece with what its triangles and vertices stand for. Triangles of the surface
/// come first, in global order, then those of interfaces.
struct PieceBoundary {
  volume::ClosedSurface surface;
  std::vector<mesh::GlobalIndex> vertex_number;  ///< per point, ascending: as in BoundaryPoint
  std::vector<std::int8_t> vertex_dimension;     ///< per point; 3 off the surface
  std::vector<std::int32_t> vertex_entity;       ///< per point
  std::vector<std::int32_t> triangle_face;       ///< per triangle: CAD face, -1 on interfaces
  std::vector<std::int32_t> triangle_patch;      ///< per triangle
  std::vector<std::int32_t> triangle_interface;  ///< per triangle: VolumePlan::faces, -1 on the surface
};

/// Parts that have been merged: the lowest part of each group stands for it.
class MergedParts {
public:
  explicit MergedParts(std::int32_t parts);
  std::int32_t root(std::int32_t part) const;
  void merge(std::int32_t a, std::int32_t b);
  std::int32_t count() const { return static_cast<std::int32_t>(_root.size()); }

private:
  std::vector<std::int32_t> _root;  // per part
};

/// The parts on either side of an interface that could not be meshed, merged.
MergedParts merge_at_failed(const VolumePlan& plan, const InterfaceMesh& interfaces);

/// The mesh of the surface with its numbers, and that of the interfaces.
struct BoundaryMeshes {
  const mesh::DistributedMesh& surface;
  const mesh::Numbering& numbering;
  const InterfaceMesh& interfaces;
};

/// Brings the boundaries of the wanted parts together on the ranks that own them: one entry per part, filled
/// for those of this rank. Interfaces inside merged parts are left out. Collective.
std::vector<PieceBoundary> gather_boundaries(const parallel::Communicator& communicator,
                                             const BoundaryMeshes& meshes, const VolumePlan& plan,
                                             const MergedParts& parts, const std::vector<char>& wanted,
                                             const std::vector<parallel::Rank>& owners);

}  // namespace aeroloom::pipeline
