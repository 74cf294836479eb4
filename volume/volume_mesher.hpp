/// The volume stage: closed triangulations filled with tetrahedra. Knows neither CAD nor decomposition.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// A closed, oriented triangulation that bounds one volume piece (outer shell and voids alike).
struct ClosedSurface {
  std::vector<geometry::Vec3> points;
  std::vector<std::array<mesh::LocalIndex, 3>> triangles;  ///< counter-clockwise seen from outside the volume
  /// Per triangle: 1 where the lattice goes on behind it, as around a cavity in a mesh; empty: nowhere.
  std::vector<std::uint8_t> continued;
};

struct VolumeOptions {
  double lattice_clearance = 0.75;         ///< distance lattice points keep from the boundary, in local sizes
  double continued_clearance = 0.25;       ///< the same from triangles behind which the lattice goes on
  double perturbation = 0.05;              ///< of lattice points, in local sizes
  std::int64_t largest_piece = 5'000'000;  ///< predicted tetrahedra above which a piece is refused
  int retries = 3;                         ///< rungs of the ladder after the first try
  /// What the contained run does before its work; for tests of containment.
  enum class Sabotage : std::uint8_t {
    none,
    throws,
    aborts,
    hangs,
    exhausts_memory
  } sabotage = Sabotage::none;
};

/// A piece that cannot be filled. The message says where, sizes there, what was tried, what to do, and the
/// file with the offending triangles; `triangles` are their indices in the ClosedSurface.
class VolumeError : public std::runtime_error {
public:
  VolumeError(const std::string& what, std::vector<std::int32_t> triangles)
      : std::runtime_error(what), _triangles(std::move(triangles)) {}
  const std::vector<std::int32_t>& triangles() const { return _triangles; }

private:
  std::vector<std::int32_t> _triangles;
};

/// The tetrahedra of one piece.
struct FilledVolume {
  std::vector<double> coordinates;  ///< (n,3): the surface's points first, in their order and bit for bit
  std::vector<mesh::LocalIndex> tetrahedra;  ///< (m,4), positive volume, ordered along a space-filling curve
  std::int64_t steiner_points = 0;  ///< points TetGen had to add inside and that could not be suppressed
  std::int64_t dropped_points = 0;  ///< lattice points TetGen left out of the mesh
  int attempts = 1;                 ///< rungs of the ladder climbed, the successful one included
  double cpu_seconds = 0;           ///< of this rank and of the contained runs
  std::int64_t child_peak_bytes = 0;
};

/// Interior points of a graded, slightly perturbed body-centred lattice that follows the field, inside the
/// surface and off it, along a space-filling curve. A function of position alone.
std::vector<geometry::Vec3> lattice_points(const ClosedSurface& surface, const sizing::SizeField& field,
                                           const VolumeOptions& options);

/// Fills one closed surface; the boundary is never altered. TetGen runs contained; failures climb the ladder
/// of retries (other perturbations, lattice points inserted after the boundary, none). Not collective. Throws
/// VolumeError.
FilledVolume fill_volume(const ClosedSurface& surface, const sizing::SizeField& field,
                         const VolumeOptions& options);

/// Makes the contained task known; call before parallel::Environment is constructed.
void register_volume_tasks();

}  // namespace aeroloom::volume
