/// Position, size and shape of the far field. Internal to cad/.
#pragma once

#include "cad/domain/symmetry.hpp"

#include <algorithm>
#include <optional>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// The box of the bodies before they were cut at a symmetry plane (`whole`) and after (`body`).
struct BodyBoxes {
  Box whole, body;
};

inline double largest_extent(Vec3 size) {
  return std::max({size.x, size.y, size.z});
}

/// The far field around bodies, with labelled faces. Throws CadError if it does not clear them.
TopoDS_Solid place_far_field(const FarFieldOptions& options, const BodyBoxes& bodies,
                             const std::optional<SymmetryPlane>& symmetry, FaceLabels& labels);

}  // namespace aeroloom::cad
