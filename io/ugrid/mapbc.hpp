/// Reads the .mapbc file beside a UGRID file: names and conditions of patches.
#pragma once

#include "io/shared_path.hpp"
#include "mesh/data/patch.hpp"

#include <cstdint>
#include <map>

namespace aeroloom::io {

/// The patches by id; empty where there is no such file. The first line has the number of patches; the other
/// lines are `id condition name`, with the name up to the end of the line. Rank 0 reads. Collective; throws
/// CollectiveError with the file and the line.
std::map<std::int64_t, mesh::Patch> read_mapbc(const SharedPath& file);

}  // namespace aeroloom::io
