/// Closes halves of bodies that are open on their plane of symmetry. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/on_plane.hpp"
#include "cad/repair/opening_rules.hpp"

#include <optional>
#include <string>
#include <vector>

#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>

namespace aeroloom::cad {

/// The plane of symmetry that the case asks for.
struct HalfPlane {
  std::optional<int> axis = 1;          ///< without: that of the coordinate plane with most open edges
  std::optional<double> position = {};  ///< without: where the openings are, 0 before other places
  OpeningRules* openings = nullptr;     ///< for openings beside the plane; null: none
};

/// What close_half made, or why it made nothing.
struct ClosedHalf {
  std::vector<TopoDS_Shell> shells;  ///< closed; empty with a fault
  FaceLabels labels;
  AxisPlane plane;
  Changes changes;
  std::string fault;
};

/// Closes shells whose open edges are on the plane, or lead to it. What lies beyond the plane is cut off.
/// Edges nearer than `tolerances::on_symmetry` of the diagonal are put on the plane. Where the border leaves
/// it, faces along its normal close blunt bases, open tips and jags down to it (border_chains.hpp); planar
/// openings elsewhere get caps. The plane itself closes the rest with faces of which none is left in a half
/// far field. The shape stays as it is; labels follow.
ClosedHalf close_half(const TopoDS_Shape& open, const FaceLabels& labels, const HalfPlane& half);

/// The plane near which most of the open edges lie, of those that `half` allows: at 0, or at the ends of the
/// box on its axis, unless that reaches a little beyond 0. Empty if there is none.
std::optional<AxisPlane> plane_along(const std::vector<TopoDS_Edge>& open, const Box& box,
                                     const HalfPlane& half);

/// The axis of the coordinate plane near which all open edges lie, for messages. Empty if there is none.
std::optional<AxisPlane> plane_of_openings(const std::vector<TopoDS_Edge>& open, double diagonal);

}  // namespace aeroloom::cad
