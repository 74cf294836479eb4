/// Pictures of the tetrahedra that a plane cuts.
#pragma once

#include "pipeline/report/picture_subject.hpp"

namespace aeroloom::report {

/// Through the middle of the body, or just inside of the plane that half a body ends at. Collective.
Picture cut_picture(const PictureSubject& subject, const mesh::DistributedMesh& volume);
/// Across a leading edge or the sharpest place. Collective.
Picture leading_edge_cut_picture(const PictureSubject& subject, const mesh::DistributedMesh& volume,
                                 const picture::Place& place);

}  // namespace aeroloom::report
