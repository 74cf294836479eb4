/// Which faces bound the far field, where sizes are those of the far field and not of walls.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// What the boundary condition of a face says of it. `open`: nothing.
enum class FaceRole : std::uint8_t { open, wall, symmetry, far_field };

struct FarFieldFaces {
  std::vector<bool> faces;
  std::string decision;  ///< why, a sentence for log and report
};

/// The body's largest extent times this fits on each side between its middle and the far field: the far
/// field is at least three times as large.
inline constexpr double least_far_field_distance = 1.5;

/// The faces that the program made as far field, and those with the role `far_field`; with such a face planar
/// ones with the role `symmetry`, too. Besides, faces of the outer boundary without the role `wall`, where
/// all of it is a far field. It is that if it is a box, sphere, cylinder or half of one, holds a body, and is
/// at least least_far_field_distance away. One side, the plane of symmetry or the ground, may be nearer and
/// touch the body. `roles`: by face, or none. Equal on every rank. Collective. Throws CollectiveError where
/// the CAD library fails on a face.
FarFieldFaces find_far_field(const parallel::Communicator& communicator, const cad::Model& model,
                             const std::vector<FaceRole>& roles = {});

}  // namespace aeroloom::sizing
