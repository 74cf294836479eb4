/// Imports a mesh that another program made as a distributed mesh.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::imported {

/// Cuts a mesh of tetrahedra along a space-filling curve into pieces of about `piece_tets` tetrahedra (empty:
/// a suitable number), of one region each. A patch becomes a face of the model for each region that it
/// bounds, and for each pair of regions that it separates (io/raw_mesh.hpp). Its vertices are classified on
/// these faces. The pieces do not depend on the number of ranks. Collective. Throws CollectiveError (input)
/// with `path` where the mesh has pyramids or prisms.
mesh::DistributedMesh pieces_of(const io::FileMesh& mesh, const std::string& path,
                                std::optional<std::int64_t> piece_tets);

/// Reads a file (io/read_mesh.hpp) and cuts it as above. Collective. Throws CollectiveError where the file
/// cannot be read, or is no conforming mesh of tetrahedra. Warns of doubled nodes (io/doubled_nodes.hpp).
mesh::DistributedMesh import_mesh(const io::SharedPath& file, std::optional<std::int64_t> piece_tets);

}  // namespace aeroloom::imported
