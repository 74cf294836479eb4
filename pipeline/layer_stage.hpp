/// The stage of boundary layers, between surface and volume. The volume fills the space inside the layer cap,
/// the outer surface of the layers.
#pragma once

#include "layers/layer_cells.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/finished_surface.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace aeroloom::pipeline {

/// The layers on a surface, and the layer cap with its sizes, from which the volume starts.
struct LayersAndCap {
  layers::Columns columns;
  std::shared_ptr<const layers::OpenedWall> opened;  ///< what columns stand on, where inner faces have layers
  sizing::SizedSurface cap;
  report::LayerRecord record;
};

/// Builds layers on the walls of the surface. Planes where layers end are meshed again. Collective. Throws
/// std::invalid_argument for layers on a patch that does not exist.
LayersAndCap build_layers(const cases::Case& input, FinishedSurface& surface);

/// By piece and triangle of the surface: the number of layers over it, -1 where none are asked for. Of
/// the sides of inner faces the one with more counts.
std::vector<std::vector<std::int32_t>> layers_over_triangles(const mesh::DistributedMesh& surface,
                                                             const LayersAndCap& layered);

/// Adds the cells of the layers to the volume. Collective.
void append_layers(const cases::Case& input, const mesh::NumberedMesh& surface, const LayersAndCap& layered,
                   mesh::DistributedMesh& volume);

}  // namespace aeroloom::pipeline
