/// Where a far field stands and what it looks like. Seen by this folder only.
#pragma once

#include "cad/domain/symmetry.hpp"

#include <algorithm>
#include <optional>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// Boxes of the bodies: before they were cut at a plane of symmetry, and of what is left.
struct BodyBoxes {
  Box whole, body;
};

inline double largest_extent(Vec3 size) {
  return std::max({size.x, size.y, size.z});
}

/// The far field around bodies, its faces labelled. Throws CadError where it does not clear them.
TopoDS_Solid place_far_field(const FarFieldOptions& options, const BodyBoxes& bodies,
                             const std::optional<SymmetryPlane>& symmetry, FaceLabels& labels);

}  // namespace aeroloom::cad
