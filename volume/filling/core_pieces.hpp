/// The core becomes part of the mesh. A tetrahedron with a point on the border goes to the piece of the
/// lowest zone there, and is like any other from then on; the others become pieces of their own, ranges of
/// the curve of equal weight.
#pragma once

#include "volume/filling/zone_piece.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/zones/shell.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::volume {

/// A piece of the core, the place of its range along the curve in its id.
struct CoreMesh {
  std::vector<mesh::Piece> pieces;  ///< of this rank, by id, then region
  std::int64_t tetrahedra = 0;      ///< of this rank, those that went to zones included
};

/// Adds to the zones' results what is theirs; a zone without piece in a region gets one. Collective. Throws
/// std::logic_error where a tetrahedron is flat or inverted.
CoreMesh make_core(const Lattice& lattice, const Shell& shell, std::map<ZoneIndex, ZoneResult>& results);

}  // namespace aeroloom::volume
