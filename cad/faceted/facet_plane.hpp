/// The plane of symmetry of bodies of triangles. Internal to cad/faceted/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/faceted/facet_soup.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A plane normal to a coordinate axis, and the side on which the fluid lies.
struct FacetPlane {
  int axis = 1;
  double position = 0;
  bool positive = true;  ///< the fluid has larger coordinates than the plane
  double reach = 0;      ///< what is nearer and belongs to the plane is put on it
  double same = 0;       ///< points nearer than this are on the plane
  std::string reason;    ///< how it was found
  geometry::Box whole;   ///< of the bodies before they are cut

  /// How far a point lies on the fluid's side.
  double height(geometry::Vec3 p) const { return positive ? p[axis] - position : position - p[axis]; }
  bool holds(geometry::Vec3 p) const { return p[axis] == position; }
};

/// "y = 0", in the file's unit.
std::string name_of(const FacetPlane& plane);

/// The plane that the options ask for, if any. It is the position of the options; else where most of the open
/// sides are; else 0, if bodies reach across it; else where they end in flat sides. 0 comes before the ends
/// of the box. A hemisphere without an axis takes y = 0 for bodies that are symmetric about it, else the
/// coordinate plane with most open sides or flat sides. Throws CadError if there is none, or if the bodies do
/// not reach it.
std::optional<FacetPlane> find_facet_plane(const FacetSoup& soup, const FarFieldOptions& options);

/// The coordinate plane on which most of the open sides lie, as "y = 0". Empty if there is none.
std::optional<FacetPlane> plane_of_open_sides(const FacetSoup& soup);

/// For each triangle whether it belongs to a flat side on the plane: all its corners are within reach, and it
/// looks at the plane.
std::vector<char> flat_side_triangles(const FacetSoup& soup, const FacetPlane& plane);

/// Throws CadError for a flat side that looks at the plane, reaches it and leaves it by more than its reach,
/// with tilt and distances.
void refuse_missing_flat_sides(const FacetSoup& soup, const FacetPlane& plane);

}  // namespace aeroloom::cad
