/// Faces of tori whose tube is wider than their ring. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// A torus whose tube is wider than its ring crosses itself in two points of its axis. STEP has such surfaces
/// for their outer part (ISO 10303-42, degenerate_toroidal_surface); the CAD library takes the whole tube,
/// with an inner part that bounds nothing. Faces all around the tube without a border become the outer part.
/// Labels follow.
void trim_spindle_tori(NamedShape& named, Changes& changes);

}  // namespace aeroloom::cad
