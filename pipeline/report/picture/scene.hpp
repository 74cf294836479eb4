/// Selects what pictures show: the body in the flow, or the walls around the flow.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// Twice the area times the unit normal of a triangle. It points out of the region in front of the triangle,
/// away from the flow at a wall.
geometry::Vec3 area_normal(const mesh::Piece& piece, mesh::LocalIndex triangle);

/// By local piece and triangle: 1 if it is shown.
using Shown = std::vector<std::vector<std::uint8_t>>;

/// What pictures show; equal on every rank except for `shown`.
struct Scene {
  /// Whether a body stands in the flow. Otherwise the flow is internal and all walls are shown.
  bool has_body = false;
  Shown shown;
  std::vector<std::uint8_t> patches;  ///< by patch: whether any of its triangles is shown
  std::vector<double> patch_areas;    ///< of the shown triangles
  geometry::Box box, domain;          ///< of the shown triangles; of the whole surface
  /// Mean flow-side normal of the shown triangles: zero for a closed body; away from the symmetry plane for
  /// half a body.
  geometry::Vec3 open_towards;
};

/// Selects triangles. Far field, symmetry planes and faces between regions are never shown. Without a
/// far-field patch, triangles on the convex hull of the domain are hidden if they enclose the rest. The hull
/// is known by its farthest points in 200 directions; a triangle lies on it to 0.15 of its longest edge. Such
/// triangles enclose the rest if their area vectors cancel to 15 % (half a body leaves a hole in the symmetry
/// plane, a bend half of its walls) and they hold nine tenths of the volume. In a duct they do not. `types`:
/// by patch; missing ones are walls. Collective.
Scene find_scene(const mesh::DistributedMesh& surface, const std::vector<mesh::PatchType>& types);

}  // namespace aeroloom::picture
