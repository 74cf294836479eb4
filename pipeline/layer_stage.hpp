/// Boundary layers in a run: between the surface and the volume, which fills what is behind their front.
#pragma once

#include "layers/layer_cells.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/run.hpp"

namespace aeroloom::pipeline {

/// The layers on a surface, and what the volume starts from: their front, and sizes that go with it.
struct LayeredSurface {
  layers::Columns columns;
  sizing::SizedSurface front;
};

/// Columns on the walls of the surface; planes that layers end on are meshed again. Collective. Throws
/// std::invalid_argument for layers of patches that there are not.
LayeredSurface build_layers(const cases::Case& input, FinishedSurface& surface, report::RunRecord& record);

/// Puts the layers before the tetrahedra behind their front. Collective.
void append_layers(const cases::Case& input, const mesh::NumberedMesh& surface, const LayeredSurface& layered,
                   mesh::DistributedMesh& volume);

}  // namespace aeroloom::pipeline
