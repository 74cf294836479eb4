/// The volume stage: from a surface mesh and sizes to tetrahedra, without interfaces. All points are known
/// before any tetrahedron exists, and the Delaunay mesh of points in general position is unique: so
/// overlapping zones of space are meshed on their own, agree where they overlap, and each keeps its own
/// tetrahedra.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_options.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// What is meshed. Refers to what lives elsewhere.
struct VolumeInput {
  const mesh::DistributedMesh& surface;  ///< closed around every region, its vertices classified
  const mesh::Numbering& numbering;      ///< of the surface
  const sizing::SizeField& field;
  VolumeOptions options;
};

/// What the decomposition tells.
struct DecompositionReport {
  std::int64_t blocks = 0;  ///< of the lattice
  std::int64_t lattice_points = 0;
  double expected_tetrahedra = 0;  ///< from points and triangles
  std::int32_t zones = 0;
  double imbalance = 1;  ///< heaviest zone over the mean, halo included
};

/// A zone that could not be filled at first.
struct Retry {
  std::int32_t zone;
  std::string change;  ///< what was done about it
  std::string reason;
};

/// A place where zones made different tetrahedra, and which of them counts.
struct Disagreement {
  geometry::Vec3 place;
  std::int32_t zone;   ///< that counts
  std::int32_t faces;  ///< that did not match
  std::int32_t round;
};

/// What the filling tells.
struct VolumeReport {
  std::int64_t tetrahedra = 0;
  double halo = 1;                  ///< lattice points that zones know, all together, over those there are
  std::int64_t steiner_points = 0;  ///< that TetGen had to add inside
  std::vector<Retry> retries;
  std::vector<Disagreement> disagreements;
  int rounds = 1;            ///< of filling; further ones fill again what failed or disagreed
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below
};

/// The points and zones of a volume. Each rank has the points of its blocks.
class Decomposition {
public:
  struct Parts;
  explicit Decomposition(std::unique_ptr<Parts> parts);
  Decomposition(Decomposition&&) noexcept;
  Decomposition& operator=(Decomposition&&) noexcept;
  ~Decomposition();

  const DecompositionReport& report() const;
  Parts& parts() { return *_parts; }

private:
  std::unique_ptr<Parts> _parts;
};

/// Makes the lattice and divides it into zones. A function of surface, sizes and options, whatever the ranks.
/// Collective. Throws CollectiveError.
Decomposition decompose(const parallel::Communicator& communicator, const VolumeInput& input,
                        parallel::StageClock& clock);

/// A zone that no rung of the ladder fills. The message names CAD faces, place and sizes, what was tried and
/// what to do; the triangles at fault are for a file to look at. The same on every rank.
class VolumeFailure : public parallel::CollectiveError {
public:
  VolumeFailure(const std::string& message, std::vector<geometry::Vec3> points,
                std::vector<std::array<mesh::LocalIndex, 3>> triangles)
      : CollectiveError(parallel::FailureKind::input, message),
        _points(std::move(points)),
        _triangles(std::move(triangles)) {}
  const std::vector<geometry::Vec3>& points() const { return _points; }
  const std::vector<std::array<mesh::LocalIndex, 3>>& triangles() const { return _triangles; }

private:
  std::vector<geometry::Vec3> _points;
  std::vector<std::array<mesh::LocalIndex, 3>> _triangles;
};

/// Fills the zones, dealt out largest first, and proves that they fit together. A zone that cannot be filled
/// gets other perturbations of its points, then points farther off the surface, then is merged with a
/// neighbour; where zones disagree the lowest of them counts. One mesh piece per zone and region, by zone,
/// then region. The triangles of a face between two regions belong to pieces of its front region. Collective.
/// Throws VolumeFailure.
mesh::DistributedMesh fill_zones(const parallel::Communicator& communicator, const VolumeInput& input,
                                 Decomposition decomposition, parallel::StageClock& clock,
                                 VolumeReport& report);

/// Makes the contained task known; call before parallel::Environment is constructed.
void register_volume_tasks();

}  // namespace aeroloom::volume
