/// Bodies made one, and the fluid around them. Seen by this folder only.
#pragma once

#include "aeroloom/cad/domain/domain.hpp"
#include "aeroloom/cad/repair/change.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/volumes.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// Bodies that touch or overlap become one solid each (boolean union, its volume checked); labels follow.
NamedShape unite_bodies(NamedShape bodies, Volumes& volumes, Changes& changes);

/// Solids that touch come to share their common faces, so that meshes of neighbouring regions conform. Throws
/// CadError where they overlap.
NamedShape join_regions(NamedShape regions, Volumes& volumes, Changes& changes);

/// The space between the far field and the bodies, which are disjoint. No boolean operation with the far
/// field: the bodies' outer shells become voids of it, or join it along the outlines of their sections at the
/// plane of symmetry, which is exact and keeps faces and labels. Throws CadError where the far field does not
/// clear the bodies, or when the volumes do not add up.
NamedShape surround(NamedShape bodies, const FarFieldOptions& options, Volumes& volumes, Changes& changes);

}  // namespace aeroloom::cad
