/// Makes closed solids from the content of a file. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/half_shells.hpp"
#include "cad/repair/opening_rules.hpp"
#include "cad/repair/volumes.hpp"

#include <optional>
#include <vector>

#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// The solids of a shape, in order.
std::vector<TopoDS_Solid> solids_of(const TopoDS_Shape& shape);
TopoDS_Shape make_compound(const std::vector<TopoDS_Solid>& solids);

/// The solid without the faces inside of it.
TopoDS_Shape without_inner_faces(const TopoDS_Shape& solid);

/// Makes a compound of closed solids with outward orientation. Solids of the file are kept and closed shells
/// become solids. Open and loose faces are sewn (sewing.hpp), with tolerances up to a tenth of
/// `smallest_size`; 0: no limit. Noise is closed (noise.hpp). Labels follow. Every change is appended to
/// `changes`. Faces that bound no solid are in `loose` of the result: those inside of solids, loose ones, and
/// open shells beside solids, which are sheets (sewing.hpp). Throws CadError that lists open edges if no
/// closed solid results, and for solids without volume.
/// `openings`: rules for what is open; null: none.
/// Open halves are closed by the plane of symmetry `half` (half_shells.hpp), whose position is in the result.
NamedShape make_solids(NamedShape named, double smallest_size, Volumes& volumes, Changes& changes,
                       const std::optional<HalfPlane>& half = {}, OpeningRules* openings = nullptr);

}  // namespace aeroloom::cad
