/// A mesh that another program made, as a distributed mesh.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::foreign {

/// Reads a file (io/vtk/vtk_reader.hpp) and deals it out in pieces of about `piece_tets` tetrahedra (empty: of
/// what suits their number). Each region of the file stays one; its outer boundary and the boundary between
/// two regions become one face each. The same pieces for any number of ranks; rank 0 reads and cuts.
/// Collective. Throws CollectiveError when the file cannot be read or is no conforming mesh of tetrahedra.
mesh::DistributedMesh load_foreign_mesh(const parallel::Communicator& communicator, const std::string& path,
                                        std::optional<std::int64_t> piece_tets);

}  // namespace aeroloom::foreign
