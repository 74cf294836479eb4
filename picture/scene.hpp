/// What a picture is about: the body in the flow, or the walls around it.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::picture {

/// The same on every rank.
struct Scene {
  /// Whether there is a body in the flow. Else the flow is inside, and all its walls are shown.
  bool has_body = false;
  std::vector<std::uint8_t> shown;    ///< by CAD face
  std::vector<std::uint8_t> patches;  ///< by patch: whether a face of it is shown
  std::vector<double> patch_areas;    ///< of what is shown of it
  geometry::Box box, domain;          ///< of what is shown, of everything
  /// The mean flow-side normal of what is shown: zero for a closed body, away from the plane of symmetry for
  /// half of one.
  geometry::Vec3 open_towards;

  bool shows(std::int32_t face) const {
    return face >= 0 && static_cast<std::size_t>(face) < shown.size() && shown[face] != 0;
  }
};

/// Far field, planes of symmetry and faces between regions are never shown. Where no patch is a far field,
/// the faces on the convex hull of the domain are left out if they enclose the rest: the hull is known by its
/// farthest points in 200 directions, a face lies on it if five of its triangles do, to 2 % of the
/// domain's diagonal; the faces enclose the rest if their areas cancel to 5 % and hold nine tenths of the
/// volume. In a duct they do not. `types` by patch; those left out are walls. Collective.
Scene find_scene(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                 const std::vector<mesh::PatchType>& types);

}  // namespace aeroloom::picture
