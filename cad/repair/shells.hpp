/// Closed shells, and solids made from nested shells. Internal to cad/.
#pragma once

#include "cad/repair/volumes.hpp"

#include <vector>

#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

/// Whether every edge has two faces, so that the shell encloses space. Degenerate edges do not count.
bool is_closed(const TopoDS_Shell& shell);

/// The solid of one closed shell, oriented outward.
TopoDS_Solid solid_of(const TopoDS_Shell& shell, Volumes& volumes);

/// Makes solids from closed shells. Each shell at even nesting depth becomes a solid; the shells directly
/// inside it become its voids.
std::vector<TopoDS_Solid> nest_shells(const std::vector<TopoDS_Shell>& shells, Volumes& volumes);

/// The number of solids that lie in a cavity of another solid, whether they fill it or not.
int count_in_cavities(const std::vector<TopoDS_Solid>& solids, Volumes& volumes);

}  // namespace aeroloom::cad
