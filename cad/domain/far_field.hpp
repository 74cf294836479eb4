/// Bodies made one, and the fluid around them. Seen by this folder only.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <string>
#include <vector>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// Bodies that touch or overlap and that no way of the CAD library unites.
struct RefusedUnion {
  std::vector<TopoDS_Solid> solids;
  std::string reason;
};

/// Bodies that touch or overlap become one solid each (boolean union, its volume checked); labels follow.
/// Those that cannot be united are left out and appended to `refused`.
NamedShape unite_bodies(NamedShape bodies, Volumes& volumes, Changes& changes,
                        std::vector<RefusedUnion>& refused);

/// As unite_bodies, but what touches or overlaps is refused for this reason untried.
NamedShape refuse_unions(NamedShape bodies, const std::string& reason, std::vector<RefusedUnion>& refused);

/// Solids that touch come to share their common faces, so that meshes of neighbouring regions conform. Throws
/// CadError where they overlap.
NamedShape join_regions(NamedShape regions, Volumes& volumes, Changes& changes);

/// The space between the far field and the bodies, which are disjoint. No boolean operation with the far
/// field: the bodies' outer shells become voids of it, or join it along the outlines of their sections at the
/// plane of symmetry, which is exact and keeps faces and labels. Throws CadError where the far field does not
/// clear the bodies, or when the volumes do not add up. `beside` is the box of what stands in the space
/// besides: the far field is placed around it too, and it must not reach a plane of symmetry.
NamedShape surround(NamedShape bodies, const FarFieldOptions& options, Volumes& volumes, Changes& changes,
                    const Box& beside = {});

}  // namespace aeroloom::cad
