/// Predicts time and memory of a run from predicted counts (constants: docs/usage.md).
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/layer_forecast.hpp"
#include "pipeline/study/prediction_files.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>
#include <vector>

namespace aeroloom::pipeline {

/// Seconds of one core.
double predicted_seconds(const sizing::PredictedCounts& counts);
/// Bytes of memory, all ranks together.
double predicted_bytes(const sizing::PredictedCounts& counts, int ranks);

/// The useful number of ranks. Geometry and sizing are replayed as `measured`; surface, layers and volume
/// count as equal pieces of predicted cost without communication. Throws std::runtime_error if `measured` has
/// no geometry or sizing.
study::WorthwhileRanks predicted_ranks(study::RunCosts measured, const sizing::PredictedCounts& counts,
                                       const std::optional<LayerForecast>& layers, const cases::Case& input);

/// Throws CollectiveError (resources), with what would fit, if the run is predicted to exceed
/// `input.memory_limit` bytes on the fullest node. No limit: does nothing. `types`: by patch of the model.
/// Collective.
void require_memory(const domain::SizedDomain& sized, const std::vector<mesh::PatchType>& types,
                    const cases::Case& input);

}  // namespace aeroloom::pipeline
