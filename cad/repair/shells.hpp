/// Closed shells and which of them lies in which. Seen by this folder only.
#pragma once

#include "cad/repair/volumes.hpp"

#include <vector>

#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// Whether every proper edge of the shell is shared, so that it encloses space.
bool is_closed(const TopoDS_Shell& shell);

/// A solid of one closed shell, oriented outward.
TopoDS_Solid solid_of(const TopoDS_Shell& shell, Volumes& volumes);

/// Solids from closed shells: each shell at even nesting depth becomes a solid, the shells directly inside it
/// become its voids.
std::vector<TopoDS_Solid> nest_shells(const std::vector<TopoDS_Shell>& shells, Volumes& volumes);

/// How many of the solids lie within another's outer shell but not in its material: in a cavity, whether they
/// fill it or not.
int count_in_cavities(const std::vector<TopoDS_Solid>& solids, Volumes& volumes);

}  // namespace aeroloom::cad
