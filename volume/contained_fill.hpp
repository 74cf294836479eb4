/// One try at filling a surface, in a contained child.
#pragma once

#include "geometry/vec.hpp"
#include "parallel/contained.hpp"
#include "volume/filling.hpp"
#include "volume/tetgen_run.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// What one try is given.
struct FillRequest {
  std::vector<geometry::Vec3> points;  ///< of the surface, interior ones, then a scaffold outside
  std::size_t surface_points = 0, interior_points = 0;
  std::vector<Triangle> triangles;
  InteriorPoints interior = InteriorPoints::at_once;
  VolumeOptions::Sabotage sabotage = VolumeOptions::Sabotage::none;
};

/// What came of it. The filling is checked.
struct FillReply {
  bool filled = false;
  std::string failure;  ///< why not, one line or more
  FilledVolume volume;  ///< cost and memory are set in either case
};

/// Runs TetGen in a child under limits that follow from the predicted count. Nothing the child does harms the
/// caller.
FillReply fill_contained(const FillRequest& request);

/// Tetrahedra around a lattice point, and next to the boundary, per triangle.
inline constexpr std::int64_t tetrahedra_per_point = 6, tetrahedra_per_triangle = 2;
/// Tetrahedra to expect.
std::int64_t predict_tetrahedra(const FillRequest& request);

}  // namespace aeroloom::volume
