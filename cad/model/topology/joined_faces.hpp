/// Several CAD faces seen as one: virtual topology over an unchanged model.
///
/// A joined face has the loops of all its members; an edge between two members is passed twice by it, like a
/// seam, and constrains nothing. Its parameter plane holds those of the members side by side ("sheets"),
/// shifted along u. Sheffer, Blacker and Bercovier, Clustering: automated detail suppression using virtual
/// topology, ASME AMD 220, 1997.
#pragma once

#include "cad/model/model.hpp"

#include <vector>

namespace aeroloom::cad {

/// The model with each group of faces seen as one, which takes the name of the member with the largest area;
/// faces keep their order, that of a group being that of its first member. Members of a group lie in one
/// patch, between the same regions, and share edges; nobody is a member twice, no member is far field, and
/// all or none are exact planes (Model::is_exact_plane); otherwise throws std::invalid_argument. serialise()
/// gives the model without groups.
Model join_faces(const Model& model, const std::vector<std::vector<FaceId>>& groups);

}  // namespace aeroloom::cad
