/// Whether solids are the fluid or bodies in it, and what a face is called. Seen by this folder only.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model_data.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// Solids against their convex hull.
struct HullComparison {
  double fill = 0;            ///< volume of the solids over that of the hull
  std::vector<char> on_hull;  ///< per face: it is part of the hull's surface
  int inner_faces =
      0;  ///< faces with much of the hull in front of them, as around an obstacle or in a cavity
};

/// Compares by coarse facets and a polytope of some 200 half spaces around them. `volume` is that of all
/// solids.
HullComparison compare_with_hull(const Model& solids, double volume);

struct KindDecision {
  DomainKind kind;
  std::string reason;
};

/// Fluid when the solids nearly fill their hull and faces lie well inside it (a box minus an aircraft);
/// otherwise bodies.
KindDecision decide_kind(const HullComparison& comparison);

/// "xmin" and so on for a flat face on the box; empty otherwise.
std::string side_of_box(const Box& face, const Box& all);

/// Face and patch names of the domain, by TopExp's order of faces. A patch is called as its face where the
/// file names it. Unnamed faces between two regions are called "interface_<region>_<region>". Unnamed faces
/// of bodies go by solid, layer or colour, in this order, and last "body"; those of a ready-made fluid by
/// layer or colour, then "xmin" ... "zmax" for planar faces on the domain's box, "outer" for others on its
/// hull, and "body" for the rest.
std::vector<FaceTag> tag_faces(const NamedShape& domain, DomainKind kind, const HullComparison* hull);

}  // namespace aeroloom::cad
