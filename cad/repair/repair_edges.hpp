/// Adds missing curves of edges and replaces inconsistent ones. Internal to cad/repair/.
#pragma once

#include "cad/repair/change.hpp"

#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// Gives every edge a curve in space and a parameter curve on each of its faces. Replaces parameter curves
/// that leave their edge by more than `tolerance` because the two are parametrised differently. Changes the
/// shape in place and appends to `changes`.
void repair_edges(const TopoDS_Shape& shape, double tolerance, Changes& changes);

}  // namespace aeroloom::cad
