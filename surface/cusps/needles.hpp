/// Needles: triangles of the surface with an angle below ten degrees, and whether the CAD forces them.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "surface/curves/curves.hpp"
#include "surface/surface_report.hpp"

#include <vector>

namespace aeroloom::surface {

/// A triangle whose smallest angle is below `needle_degrees`.
struct Needle {
  std::size_t piece = 0;  ///< among those of this rank
  mesh::LocalIndex triangle = 0;
  NeedleCause cause = NeedleCause::mesh;
  double degrees = 0;
};

/// The needles on this rank, by piece and triangle. `surface` must be as the surface stage makes it, with the
/// keys of `curves` at its vertices on curves.
std::vector<Needle> find_needles(const cad::Model& model, const CurveMesh& curves,
                                 const mesh::DistributedMesh& surface);

/// Needles by CAD face and cause, the same on every rank and for any number of ranks. Collective.
std::vector<NeedleGroup> group_needles(const mesh::DistributedMesh& surface,
                                       const std::vector<Needle>& needles);

}  // namespace aeroloom::surface
