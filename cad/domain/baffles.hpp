/// Faces inside of the fluid. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

namespace aeroloom::cad {

/// Puts the loose faces of a fluid into its solids and forgets them. What lies inside of a solid becomes a
/// baffle there: it shares edges with walls and other baffles that it meets. Where a baffle ends inside of a
/// wall, the wall is divided along lines of constant parameters, because a face has no edges inside of it.
/// Faces across the whole fluid divide it into regions. Loose faces outside of the fluid are dropped; each
/// face is listed in `changes`. Without baffles the shape stays as it is. Returns whether there are any.
/// Throws CadError that names the first baffle with `refuse`, if the CAD library cannot place one, or for
/// open shells outside of the fluid.
bool place_baffles(NamedShape& fluid, Baffles treatment, Volumes& volumes, Changes& changes);

/// The number of loose faces that lie inside of solids, with a point in their middle at least.
int count_loose_inside(const NamedShape& solids);

/// Forgets the loose faces of bodies, and lists them as dropped. Throws CadError for open shells.
void drop_loose(NamedShape& bodies, Changes& changes);

}  // namespace aeroloom::cad
