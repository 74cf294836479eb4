/// What layers on sides of inner faces ask of an opened wall, and what is told of them.
#pragma once

#include "layers/columns.hpp"

#include <vector>

namespace aeroloom::layers {

/// Whether layers are asked for on a side of an inner face. Collective.
bool has_inner_layers(const mesh::DistributedMesh& wall, const LayerOptions& options);

/// The options of the opened wall: those of its patches.
LayerOptions options_of_sides(const OpenedWall& opened, const LayerOptions& options);

/// Adds the figures of both sides of inner faces to those of their patches, and leaves only these.
std::vector<PatchLayers> join_sides(const OpenedWall& opened, const std::vector<PatchLayers>& patches);

}  // namespace aeroloom::layers
