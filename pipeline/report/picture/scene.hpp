/// The scene of a picture: the body in the flow, or the walls around it.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// Twice the area times the unit normal of a triangle: out of the region in front of it, that is away from
/// who looks at a wall from the flow.
geometry::Vec3 area_normal(const mesh::Piece& piece, mesh::LocalIndex triangle);

/// Per local piece, one for each triangle: 1 where it is shown.
using Shown = std::vector<std::vector<std::uint8_t>>;

/// The body or the walls that pictures show; the same on every rank but for `shown`.
struct Scene {
  /// Whether there is a body in the flow. Else the flow is inside, and all its walls are shown.
  bool has_body = false;
  Shown shown;
  std::vector<std::uint8_t> patches;  ///< by patch: whether a triangle of it is shown
  std::vector<double> patch_areas;    ///< of what is shown of it
  geometry::Box box, domain;          ///< of what is shown, of everything
  /// The mean flow-side normal of what is shown: zero for a closed body, away from the plane of symmetry for
  /// half of one.
  geometry::Vec3 open_towards;
};

/// Far field, planes of symmetry and faces between regions are never shown. Where no patch is a far field,
/// the triangles on the convex hull of the domain are left out if they enclose the rest: the hull is known by
/// its farthest points in 200 directions, a triangle lies on it to 0.15 of its longest edge; they enclose
/// the rest if their area vectors cancel to 15 % (half a body leaves a hole in the plane of symmetry, a bend
/// half of its walls) and hold nine tenths of the volume. In a duct they do not. `types` by patch; those left
/// out are walls. Collective.
Scene find_scene(const mesh::DistributedMesh& surface, const std::vector<mesh::PatchType>& types);

}  // namespace aeroloom::picture
