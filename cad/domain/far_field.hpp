/// Unites bodies and makes the fluid around them. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <string>
#include <vector>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// Bodies that touch or overlap but that the CAD library cannot unite.
struct RefusedUnion {
  std::vector<TopoDS_Solid> solids;
  std::string reason;
};

/// Unites bodies that touch or overlap, and checks the volume of each union. Labels follow. Groups of bodies
/// that cannot be united are removed and appended to `refused`.
NamedShape unite_bodies(NamedShape bodies, Volumes& volumes, Changes& changes,
                        std::vector<RefusedUnion>& refused);

/// As unite_bodies, but every group of bodies that touch or overlap is refused for this reason without a
/// trial.
NamedShape refuse_unions(NamedShape bodies, const std::string& reason, std::vector<RefusedUnion>& refused);

/// Makes solids that touch share their common faces, so that meshes of neighbouring regions conform. Throws
/// CadError if solids overlap.
NamedShape join_regions(NamedShape regions, Volumes& volumes, Changes& changes);

/// Makes the region between the far field and the bodies, which must be disjoint. The bodies' outer shells
/// become voids of the far field. At a symmetry plane they are joined to it along the outlines of their
/// sections. No boolean operation is needed, so this is exact and keeps faces and labels.
/// `beside` is the box of other bodies in the fluid. The far field encloses it, and it must not reach a
/// symmetry plane. Throws CadError if the far field does not clear the bodies or the volumes do not add up.
NamedShape surround(NamedShape bodies, const FarFieldOptions& options, Volumes& volumes, Changes& changes,
                    const Box& beside = {});

}  // namespace aeroloom::cad
