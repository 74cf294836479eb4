/// Cuts open faces at a plane. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/on_plane.hpp"

#include <optional>

#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// What is kept of an open half.
struct HalfSide {
  AxisPlane plane;
  bool positive = true;  ///< the side with larger coordinates
  double reach = 0;      ///< nothing may be left farther beyond the plane
};

struct HalfCut {
  TopoDS_Shape shape;
  double aside = 0;  ///< distance of the cut from the plane
};

/// The faces on one side of the plane. Where the CAD library goes wrong, as at edges that all but lie in the
/// plane, they are cut half of the reach beside it. Labels follow. Empty if no cut succeeds.
std::optional<HalfCut> cut_open_half(const TopoDS_Shape& shape, const HalfSide& side, FaceLabels& labels);

}  // namespace aeroloom::cad
