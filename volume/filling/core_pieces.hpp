/// Adds the core to the mesh. A tetrahedron with a point on the border becomes part of the piece of the
/// lowest zone at its border points. All others form pieces of their own: ranges of the Morton curve with
/// equal numbers of tetrahedra.
#pragma once

#include "volume/filling/zone_piece.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/zones/shell.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::volume {

/// The pieces of the core. The id of a piece is the index of its range.
struct CoreMesh {
  std::vector<mesh::Piece> pieces;  ///< of this rank, by id, then region
  std::int64_t tetrahedra = 0;      ///< of this rank, with those that were added to zones
};

/// Makes the core. Adds the tetrahedra of zones to `results`; a zone without a piece in the region gets one.
/// Throws std::logic_error if a tetrahedron is flat or inverted. Collective.
CoreMesh make_core(const Lattice& lattice, const Shell& shell, std::map<ZoneIndex, ZoneResult>& results);

}  // namespace aeroloom::volume
