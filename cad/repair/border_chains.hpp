/// Chains of open edges that leave a plane, and the faces between them and the plane. Internal to cad/.
#pragma once

#include "cad/repair/on_plane.hpp"

#include <optional>
#include <string>
#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// Open edges one after the other, from a vertex on the plane to another one, or back to the first vertex
/// without one on the plane.
struct BorderChain {
  std::vector<TopoDS_Edge> edges;  ///< oriented along the chain
  bool on_plane = false;           ///< its ends are on the plane
};

/// Chains of the edges that are not on the plane. Empty, with a place in `branch`, if more or fewer than two
/// of them meet beside the plane. `feet`: vertices on the plane.
std::optional<std::vector<BorderChain>> find_chains(const std::vector<TopoDS_Edge>& edges,
                                                    const TopTools_IndexedMapOfShape& feet, Vec3& branch);

/// Lengths of a filling.
struct FillLimits {
  double reach = 0;     ///< edges that run along the plane by less stand on it
  double straight = 0;  ///< what runs along a straight line of the plane, to this, gets a planar face
  double widest = 0;    ///< largest height of a ruled face
};

/// Faces between a chain and the plane.
struct ChainFilling {
  std::vector<TopoDS_Face> faces;
  double width = 0;      ///< largest distance of the chain from the plane
  double length = 0;     ///< of the chain
  Vec3 where;            ///< of the largest distance
  bool is_wide = false;  ///< a face would be ruled and wider than the limit: no faces then
};

/// Draws faces along the plane's normal from a chain whose ends are on the plane down to it: planar ones
/// where the chain runs along a straight line, ruled ones elsewhere. They share the chain's edges.
ChainFilling fill_to_plane(const BorderChain& chain, const AxisPlane& plane, const FillLimits& limits);

}  // namespace aeroloom::cad
