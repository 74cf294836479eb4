/// The expected cost of a run, from predicted counts and constants that runs have shown (docs/usage.md).
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/layer_forecast.hpp"
#include "pipeline/study/prediction_files.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::pipeline {

/// Seconds of one core.
double predicted_seconds(const sizing::PredictedCounts& counts);
/// Bytes of memory of all ranks together.
double predicted_bytes(const sizing::PredictedCounts& counts, int ranks);

/// How many ranks are worth asking for: a replay of geometry and sizing as `measured`, and of the rest,
/// layers among it where there are any, as equal pieces of predicted cost that exchange nothing. Throws
/// std::runtime_error where there is no record of those.
study::WorthwhileRanks predicted_ranks(study::RunCosts measured, const sizing::PredictedCounts& counts,
                                       const std::optional<LayerForecast>& layers, const cases::Case& input);

/// Ends a run that is predicted to take more than `input.memory_limit` bytes on its fullest node, and says
/// what would fit: CollectiveError (resources). Nothing where the limit is 0. `types` are those of the
/// model's patches, which layers depend on. Collective.
void require_memory(const domain::SizedDomain& sized, const std::vector<mesh::PatchType>& types,
                    const cases::Case& input);

}  // namespace aeroloom::pipeline
