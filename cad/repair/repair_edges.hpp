/// Curves that edges lack, or that contradict each other. Seen by this folder only.
#pragma once

#include "cad/repair/change.hpp"


#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// Gives every edge a curve in space and a parameter curve on each of its faces where it has none, and
/// replaces parameter curves that leave their edge by more than `tolerance` because they run at another pace.
/// Changes the shape in place and says what in `changes`.
void repair_edges(const TopoDS_Shape& shape, double tolerance, Changes& changes);

}  // namespace aeroloom::cad
