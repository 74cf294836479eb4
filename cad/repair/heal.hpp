/// From what a file holds to closed solids. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <vector>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// The solids of a shape, in order.
std::vector<TopoDS_Solid> solids_of(const TopoDS_Shape& shape);
TopoDS_Shape make_compound(const std::vector<TopoDS_Solid>& solids);

/// A compound of closed, outward solids: the shape's own; closed shells promoted; what remains, when there
/// are no solids, sewn (sewing.hpp) with tolerances up to a tenth of `smallest_size` (0: of any). Noise
/// is closed (noise.hpp). Labels follow. Every change is appended to `changes`. Throws CadError listing open
/// edges where no closed solid comes out, and for solids without volume.
NamedShape make_solids(NamedShape named, double smallest_size, Volumes& volumes, Changes& changes);

}  // namespace aeroloom::cad
