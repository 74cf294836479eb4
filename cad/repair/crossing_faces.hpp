/// Finds faces that pass through each other or themselves, as in sections that fold. Internal to cad/.
#pragma once

#include "cad/model/model.hpp"

#include <vector>

namespace aeroloom::cad {

/// Two faces, or one twice, that cross inside of both.
struct FaceCrossing {
  FaceId first = no_entity, second = no_entity;
  Vec3 place;
};

/// At most one crossing of each pair of faces. Coarse facets that intersect say where to look; a crossing
/// counts if the surfaces meet there, turn by more than 3 degrees against each other, and all edges of both
/// faces are farther than a thousandth of the model. So walls that come near each other do not count, nor do
/// faces that overlap along their border. Faces of triangles, joined faces and the far field are left out.
/// Throws CadError where the CAD library cannot triangulate a face.
std::vector<FaceCrossing> find_face_crossings(const Model& model);

/// Throws CadError that names faces and places.
void refuse_face_crossings(const Model& model);

}  // namespace aeroloom::cad
