/// A mesh that another program made, as a distributed mesh.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::imported {

/// Cuts a mesh of tetrahedra into pieces of about `piece_tets` tetrahedra (empty: of what suits their
/// number), of one region each, along a space-filling curve. Each patch becomes a face for each region that
/// it bounds (and each two, between regions), as io/raw_mesh.hpp has it; vertices on it are told so. The same
/// pieces for any number of ranks. Collective. Throws CollectiveError (input), naming `path`, where there are
/// pyramids or prisms.
mesh::DistributedMesh pieces_of(const io::FileMesh& mesh, const std::string& path,
                                std::optional<std::int64_t> piece_tets);

/// Reads a file (io/read_mesh.hpp) and cuts it. Collective. Throws CollectiveError when the file cannot be
/// read or is no conforming mesh of tetrahedra.
mesh::DistributedMesh import_mesh(const io::SharedPath& file, std::optional<std::int64_t> piece_tets);

}  // namespace aeroloom::imported
