/// The decomposition of the volume: which part every piece of the surface belongs to, and the background
/// triangles that the interfaces between parts are made of.
///
/// The fine surface is grouped into cells where it lies; their rims go to one rank, which makes the coarse
/// boundary of them, fills it with background tetrahedra and divides these. What comes of it is coarse and
/// the same on every rank.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "partition/coarse_surface.hpp"
#include "sizing/size_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// A vertex of surface or interfaces. Numbers below the count of surface vertices are those of the surface
/// mesh; beyond follow the vertices of interfaces. In a plan, -1 off the surface.
using BoundaryPoint = partition::FineVertex;

/// A straight background edge on an interface, or the chord of a trace on the surface.
struct InterfaceEdge {
  std::int32_t from, to;               ///< background vertices, from < to
  std::int32_t first_path, last_path;  ///< into VolumePlan::path, from end to end; equal: not on the surface
};

/// A background triangle between two parts.
struct InterfaceFace {
  std::array<std::int32_t, 3> vertices;  ///< counter-clockwise seen from `beyond`
  std::array<std::int32_t, 3> edges;     ///< edge k joins vertices k and k + 1
  std::int32_t part, beyond;             ///< the parts on either side, part < beyond
};

struct VolumePlanOptions {
  double piece_tets = 250'000;  ///< wanted size of a part
  double predicted_tets = 0;    ///< of the whole mesh: below 1.5 pieces nothing is divided
  double smallest_angle = 45;   ///< see partition::VolumeDecompositionOptions
};

/// What the decomposition tells.
struct VolumePlanReport {
  std::int64_t cells = 0, coarse_triangles = 0, background_tets = 0, clusters = 0;
  double largest_cluster = 0;  ///< in wanted loads of a part
  std::int64_t unresolved = 0, moves = 0, pinches = 0;
  int rounds = 0;        ///< in which the coarse surface was refined
  double imbalance = 1;  ///< heaviest part over the mean, predicted
};

/// The same on every rank, but for `cell`.
struct VolumePlan {
  std::int32_t parts = 0;
  std::vector<mesh::RegionId> region_of;                  ///< per part
  std::vector<double> loads;                              ///< per part: predicted tetrahedra
  std::vector<std::array<std::int32_t, 2>> part_of_cell;  ///< behind the front side of a cell, and its back
  std::vector<BoundaryPoint> vertices;                    ///< background vertices on interfaces
  std::vector<InterfaceEdge> edges;
  std::vector<InterfaceFace> faces;
  std::vector<BoundaryPoint> path;
  VolumePlanReport report;
  std::vector<std::vector<std::int32_t>> cell;  ///< per local surface piece, per triangle
};

/// Decomposes every region of the surface's inside. A function of surface, sizes and options, not of ranks.
/// Collective. Throws CollectiveError.
VolumePlan plan_volume(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                       const mesh::Numbering& numbering, const sizing::SizeField& field,
                       const VolumePlanOptions& options, parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
