/// A surface mesh in smaller pieces.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::mesh {

/// A surface mesh whose pieces have about `most` triangles at the most: larger ones are halved along the
/// longest axis of their triangles' middles until they do, and come in the order of the pieces they were;
/// those on the CAD faces `whole` (ascending) stay. Vertices keep the keys they have; those that only the
/// parts of one piece share get new ones. Ranks get runs of pieces, which are
/// near each other, by their loads (positive), which are their triangles unless given. Collective; the same
/// for any number of ranks, but for who has which piece.
NumberedMesh split_pieces(const DistributedMesh& surface, LocalIndex most,
                          const std::vector<std::int32_t>& whole,
                          const std::function<double(const Piece&)>& load_of = {});

}  // namespace aeroloom::mesh
