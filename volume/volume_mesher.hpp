/// The volume stage: from a surface mesh and sizes to tetrahedra, without interfaces. All points are known
/// before any tetrahedron exists, and the Delaunay mesh of points in general position is unique: so
/// overlapping zones of space are meshed on their own, agree where they overlap, and each keeps its own
/// tetrahedra.
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

/// The input of the volume stage. Refers to what lives elsewhere.
struct VolumeInput {
  const sizing::SizedSurface& surface;  ///< closed around every region, its vertices classified
  VolumeOptions options;
  parallel::TaskStore* tasks = nullptr;  ///< where filled zones are kept and found, if anywhere
  bool surface_numbers = false;          ///< whether pieces get mesh::Piece::surface_numbers
};

/// The points and zones of a volume. Each rank has the points of its blocks.
class Decomposition {
public:
  struct Data;
  explicit Decomposition(std::unique_ptr<Data> data);
  Decomposition(Decomposition&&) noexcept;
  Decomposition& operator=(Decomposition&&) noexcept;
  ~Decomposition();

  const DecompositionReport& report() const;
  Data& data() { return *_data; }  ///< of the stage itself (decomposition_data.hpp)

private:
  std::unique_ptr<Data> _data;
};

/// Makes the lattice and divides it into zones. A function of surface, sizes and options, whatever the ranks.
/// Collective. Throws CollectiveError, VolumeFailure where the surface contradicts itself.
Decomposition decompose(const VolumeInput& input);

/// Fills the zones, scheduled largest first, and proves that they fit together. A zone that cannot be filled
/// gets a wider halo, then other perturbations of its points, then points farther off the surface, and at
/// last is merged with a neighbour. Where zones disagree the lowest of them keeps the tetrahedra in question;
/// zones that still disagree after three rounds are merged. One mesh piece per zone and region, by zone, then
/// region. The triangles of a face between two regions belong to pieces of its front region. `input` is that
/// of decompose(); `report` starts empty. Collective. Throws CollectiveError, VolumeFailure where there are
/// triangles to look at.
mesh::DistributedMesh fill_zones(const VolumeInput& input, Decomposition decomposition, VolumeReport& report);

}  // namespace aeroloom::volume
