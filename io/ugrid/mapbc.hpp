/// Names and conditions of patches beside a UGRID file.
#pragma once

#include "mesh/data/patch.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace aeroloom::io {

/// By patch id. Lines are `id condition name`, the name up to the end of the line; the first line has their
/// count. Empty where there is no such file. Read by rank 0. Collective; throws CollectiveError naming file
/// and line.
std::map<std::int64_t, mesh::Patch> read_mapbc(const parallel::Communicator& communicator,
                                               const std::string& path);

}  // namespace aeroloom::io
