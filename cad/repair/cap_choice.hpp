/// Chooses the caps that close what is open after faces were sewn. Internal to cad/.
#pragma once

#include "cad/repair/open_faces.hpp"
#include "cad/repair/opening_rules.hpp"
#include "cad/repair/plane_loops.hpp"

#include <vector>

namespace aeroloom::cad {

/// Forms of openings.
enum class CapForm { planar, any };

/// A shape that is open wider than this fraction of its faces' area is a sheet, not a body with an opening:
/// an open half of a sphere, half of whose area its cap has, still is a body. Chosen, not measured.
inline constexpr double widest_opening = 0.5;

/// Caps for all openings: planar ones, and others over what is small or narrow (filled_loops.hpp). Openings
/// that the rules name may be as wide as they are. Empty if an opening gets none.
std::vector<Cap> choose_caps(const Sewn& sewn, double diagonal, OpeningRules* openings, CapForm form);

}  // namespace aeroloom::cad
