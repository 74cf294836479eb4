/// The volume stage: from a surface mesh and sizes to tetrahedra. All points are known before the first
/// tetrahedron, and the Delaunay mesh of points in general position is unique. So zones that overlap can be
/// meshed separately: they agree in the overlap, and no interface between them is meshed.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "sizing/field/sized_surface.hpp"
#include "volume/volume_failure.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_report.hpp"

#include <memory>

namespace aeroloom::parallel {
class TaskStore;
}

namespace aeroloom::volume {

/// The input of the volume stage. Refers to surface and tasks.
struct VolumeInput {
  const sizing::SizedSurface& surface;  ///< closed around every region, with classified vertices
  VolumeOptions options;
  parallel::TaskStore* tasks = nullptr;  ///< store of filled zones, or null
  bool surface_numbers = false;          ///< whether pieces get mesh::Piece::surface_numbers
};

/// The points and zones of a volume. Each rank has the points of its own blocks.
class Decomposition {
public:
  struct Data;
  explicit Decomposition(std::unique_ptr<Data> data);
  Decomposition(Decomposition&&) noexcept;
  Decomposition& operator=(Decomposition&&) noexcept;
  ~Decomposition();

  const DecompositionReport& report() const;
  Data& data() { return *_data; }  ///< internal (filling/decomposition_data.hpp)

private:
  std::unique_ptr<Data> _data;
};

/// Makes the lattice and divides it into zones. The result depends on surface, sizes and options alone, not
/// on the ranks. Throws CollectiveError, and VolumeFailure if the surface is not closed. Collective.
Decomposition decompose(const VolumeInput& input);

/// Fills the zones, largest first, and checks that they fit together. A zone that cannot be filled is
/// retried: with a wider halo, with other perturbations of its points, with points farther from the surface.
/// At last it is merged with a neighbour. Where zones disagree, the lowest one keeps its tetrahedra. Zones
/// that still disagree after three rounds are merged. The mesh has one piece per zone and region, by zone,
/// then region, then the pieces of the core. Triangles between two regions belong to pieces of the region on
/// their inner side. `input` is that of decompose(); `report` must be empty. Throws CollectiveError, and
/// VolumeFailure if there are triangles to show. Collective.
mesh::DistributedMesh fill_zones(const VolumeInput& input, Decomposition decomposition, VolumeReport& report);

}  // namespace aeroloom::volume
