/// Names and conditions of patches beside a UGRID file.
#pragma once

#include "io/shared_path.hpp"
#include "mesh/data/patch.hpp"

#include <cstdint>
#include <map>

namespace aeroloom::io {

/// By patch id. Lines are `id condition name`, the name up to the end of the line; the first line has their
/// count. Empty where there is no such file. Read by rank 0. Collective; throws CollectiveError naming file
/// and line.
std::map<std::int64_t, mesh::Patch> read_mapbc(const SharedPath& file);

}  // namespace aeroloom::io
