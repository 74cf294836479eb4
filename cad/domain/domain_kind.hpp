/// Decides whether solids are the fluid or bodies in it. Names faces and patches. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model_data.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// How solids compare with their convex hull.
struct HullComparison {
  double fill = 0;            ///< volume of the solids over that of the hull
  std::vector<char> on_hull;  ///< per face: it lies on the surface of the hull
  int inner_faces = 0;        ///< faces deep inside the hull, as of an obstacle or a cavity
  std::string inlet, outlet;  ///< the first of each that lies on the hull, as at the ends of a duct
};

/// The hull is that of coarse facets, approximated by about 200 half spaces. `volume` is that of all solids.
HullComparison compare_with_hull(const Model& solids, double volume, const OpeningNames& openings);

struct KindDecision {
  DomainKind kind;
  std::string reason;
};

/// The solids are the fluid if they fill most of their hull and some faces lie deep inside it, as in a box
/// minus an aircraft, or in them, as baffles do: `loose_inside` faces that bound no solid. They are the
/// fluid, too, if an inlet and an outlet lie on the hull. Those of engines lie inside of it. Otherwise the
/// solids are bodies.
KindDecision decide_kind(const HullComparison& comparison, int loose_inside = 0);

/// "xmin", "xmax" and so on if the face is flat and lies on a side of the box; empty otherwise.
std::string side_of_box(const Box& face, const Box& all);

/// Names of all faces and of their patches, in the order of TopExp. A patch has the name of its face if the
/// file names the face. For unnamed faces the patch is:
/// - between two regions: "interface_<region>_<region>" (InterfaceNames);
/// - inside of one region: "baffle";
/// - of bodies: the name of the solid, the layer or the colour, else "body";
/// - of a ready-made fluid: layer or colour; "xmin" to "zmax" on a side of the box; "outer" on the hull; else
/// "body".
std::vector<FaceTag> tag_faces(const NamedShape& domain, DomainKind kind, const HullComparison* hull);

}  // namespace aeroloom::cad
