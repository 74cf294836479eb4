/// Finds faces whose border crosses itself, which no mesher can fill. Internal to cad/.
#pragma once

#include "cad/model/model.hpp"

#include <vector>

namespace aeroloom::cad {

/// Two edges of a face, or one twice, that cross between their ends.
struct BorderCrossing {
  FaceId face = no_entity;
  EdgeId first = no_entity, second = no_entity;
  Vec3 place;
};

/// At most one crossing of each face. Borders are sampled in the parameter plane; a crossing counts if the
/// edges also meet in space there and part on both sides by more than 2e-5 of the border's extent. So
/// tolerances of corners do not count, nor do curves that touch. Faces of triangles are left out.
std::vector<BorderCrossing> find_border_crossings(const Model& model);

/// Throws CadError that names faces and places.
void refuse_border_crossings(const Model& model);

}  // namespace aeroloom::cad
