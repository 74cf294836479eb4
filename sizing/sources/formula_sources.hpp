/// How much a formula asks for, before its sources are made.
#pragma once

#include "sizing/sources/size_demands.hpp"

namespace aeroloom::sizing {

/// Cells that sources_of_formula() finds, by the formula at 32 places along each side of the domain: too few
/// where it has narrow dents. Throws std::runtime_error where it has no size.
double cells_of_formula(const FormulaSize& formula, const FormulaSpace& space);

}  // namespace aeroloom::sizing
