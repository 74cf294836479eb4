/// Flat sides of half models beside their plane of symmetry. Internal to cad/.
#pragma once

#include "cad/domain/symmetry.hpp"

namespace aeroloom::cad {

/// Whether a face of a body, which looks out of it, is its flat side on the plane: it is on the plane, or
/// nearer than the plane's reach and looks the same way.
bool is_flat_side(const TopoDS_Face& face, const SymmetryPlane& symmetry);

/// A sentence about the planar face that looks at the plane, reaches it, and leaves it by a small angle or
/// offset: its tilt in degrees and its distances. Empty if there is none.
std::string describe_missing_side(const TopoDS_Shape& bodies, const SymmetryPlane& symmetry,
                                  const FaceLabels& labels);

/// Throws CadError with that sentence, if there is such a face.
void refuse_missing_sides(const TopoDS_Shape& bodies, const SymmetryPlane& symmetry,
                          const FaceLabels& labels);

}  // namespace aeroloom::cad
