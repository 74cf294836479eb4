/// A mesh in other pieces.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>

namespace aeroloom::mesh {

/// The regions that a piece may hold.
enum class PieceRegions : std::uint8_t { several, one };

/// A volume mesh in `pieces` pieces of nearly equal numbers of cells, cut along a space-filling curve
/// (Hilbert, doi:10.1007/BF01199431) through the middles of the cells, whatever pieces it had; with
/// PieceRegions::one each region gets its share of them, one at least. Cells come by region, boundary faces
/// by patch; vertices are numbered anew by the lowest piece that knows them, shared-vertex keys are the old
/// numbers. Collective; the same for any number of ranks.
NumberedMesh repartition(const NumberedMesh& mesh, PieceId pieces,
                         PieceRegions regions = PieceRegions::several);

}  // namespace aeroloom::mesh
