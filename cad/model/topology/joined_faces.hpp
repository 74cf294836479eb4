/// Joins CAD faces into one, as virtual topology over an unchanged model (Sheffer, Blacker and Bercovier,
/// Clustering: automated detail suppression using virtual topology, ASME AMD 220, 1997).
///
/// A joined face has the loops of all its members. An edge between two members is used twice, like a seam,
/// and constrains nothing. The parameter planes of the members lie side by side along u; each is called a
/// sheet.
#pragma once

#include "cad/model/model.hpp"

#include <vector>

namespace aeroloom::cad {

/// The model with each group of faces joined. A joined face has the name of its largest member. Faces keep
/// their order; a group stands at the place of its first member. Members must lie in one patch and between
/// the same regions, and share edges. No face may be in two groups or be far field. All members or none must
/// be exact planes (Model::is_exact_plane). Throws std::invalid_argument otherwise. serialise() gives the
/// model without groups.
Model join_faces(const Model& model, const std::vector<std::vector<FaceId>>& groups);

}  // namespace aeroloom::cad
