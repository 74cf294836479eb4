/// Interior points of a piece: a graded body-centred lattice.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/size_field.hpp"
#include "volume/boundary_distance.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

struct LatticeOptions {
  double clearance = 0.75;                 ///< distance from the boundary, in local sizes
  double perturbation = 0.05;              ///< in local sizes
  int variant = 0;                         ///< another number gives other perturbations
  std::int64_t largest_count = INT64_MAX;  ///< give up above this many points
  double continued_clearance = 0.25;  ///< from triangles behind which the lattice goes on, in local sizes
  std::span<const std::uint8_t> continued = {};  ///< per triangle: 1 for those; empty: none
};

struct Lattice {
  std::vector<geometry::Vec3> points;  ///< inside the boundary and off it
  /// Outside of the boundary, close to it. Given to the mesher with the others they shorten the tetrahedra
  /// that it must first build in voids, where points of the surface alone may all lie on one sphere: the
  /// slowest case of exact arithmetic. Nothing of them stays in the mesh.
  std::vector<geometry::Vec3> scaffold;
};

/// The lattice of one piece; stops as soon as it has more than `largest_count` points.
///
/// One octree of cubic cells covers space, anchored at the centre of the field's domain. The corners and
/// centres of all its cells of one level are a body-centred lattice, and a level's lattice is part of the
/// next finer one. At a point the level is wanted whose mean edge is nearest to h on a logarithmic scale; a
/// lattice point enters when it belongs to the level wanted at its own place. So points are a function of
/// position alone, and never nearer to each other than the finer lattice has them.
Lattice body_centred_lattice(const BoundaryDistance& boundary, const sizing::SizeField& field,
                             const LatticeOptions& options);

}  // namespace aeroloom::volume
