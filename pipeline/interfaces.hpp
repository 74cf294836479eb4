/// The fine mesh of the interfaces between parts: curves first, then background triangles, each by one rank.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/volume_plan.hpp"
#include "sizing/size_field.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// A fine triangle of an interface, counter-clockwise seen from the part `beyond` of its background triangle.
struct InterfaceTriangle {
  std::array<mesh::GlobalIndex, 3> vertices;
  std::int32_t face;  ///< VolumePlan::faces
};

/// The background triangles this rank has meshed.
struct InterfaceMesh {
  std::vector<std::int32_t> faces;           ///< ascending
  std::vector<std::int32_t> first_triangle;  ///< (faces + 1)
  std::vector<InterfaceTriangle> triangles;
  std::vector<std::int32_t> first_vertex;  ///< (faces + 1)
  std::vector<BoundaryPoint> vertices;     ///< face by face, those on its rim included
  std::int64_t triangle_count = 0;         ///< of all ranks
  std::vector<std::int32_t> failed;        ///< faces too thin to be meshed, ascending, the same on every rank
};

/// Meshes all interfaces under the field; those on the surface conform to it. The parts on either side of a
/// face that fails have to be merged. `surface_vertices`: vertices of
/// the whole surface mesh; behind them are numbered background vertices, curves, inner vertices. Collective.
/// Throws CollectiveError.
InterfaceMesh mesh_interfaces(const parallel::Communicator& communicator, const VolumePlan& plan,
                              mesh::GlobalIndex surface_vertices, const sizing::SizeField& field,
                              parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
