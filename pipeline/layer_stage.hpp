/// Boundary layers in a run: between the surface and the volume, which fills what is behind their front.
#pragma once

#include "aeroloom/layers/columns.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/run.hpp"

namespace aeroloom::pipeline {

/// The layers on a surface, and what the volume starts from: their front, with the sizes that go with it.
struct LayeredSurface {
  layers::Layers layers;  ///< without the front
  FinishedSurface front;  ///< numbered as the wall; its vertices are named (layers::name_front)
};

/// Collective. Throws std::invalid_argument for patches that are none.
LayeredSurface build_layers(const parallel::Communicator& communicator, const cases::Case& input,
                            FinishedSurface& surface, report::RunRecord& record);

/// Puts the layers before the tetrahedra behind their front. Collective.
void append_layers(const parallel::Communicator& communicator, const cases::Case& input,
                   const FinishedSurface& surface, LayeredSurface layered, mesh::DistributedMesh& volume,
                   report::RunRecord& record);

}  // namespace aeroloom::pipeline
