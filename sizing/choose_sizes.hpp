/// Sizes that give a wanted number of tetrahedra.
#pragma once

#include "sizing/feature_share.hpp"
#include "sizing/model_sampler.hpp"
#include "sizing/size_field.hpp"

#include <optional>

namespace aeroloom::sizing {

/// Sizes with the field they give and the counts that field predicts.
struct ChosenSizes {
  SizingOptions options;
  SizeField field;
  PredictedCounts counts;
  FeatureShare features;
};

/// Sizes that give the target within some twenty percent, by estimates alone
/// (ModelSampler::estimate_tetrahedra), where no feature is finer than their minimum. Collective. Throws as
/// choose_sizes().
SizingOptions estimate_sizes(const ModelSampler& sampler, double target_tetrahedra);

/// Searches the one size from which all bounds follow until the predicted count is within some percent of
/// the target where no feature asks for less than the minimum. What finer features ask for comes on top, up
/// to `feature_budget` times the target in all: the rest of the model has the sizes it would have without
/// them. The search starts at `near`, sizes for a model that is almost the same, where there are such. The
/// sampler must look for gaps as closely as the default options ask, or not at all. Collective. Throws
/// std::invalid_argument for a target below one.
ChosenSizes choose_sizes(const ModelSampler& sampler, double target_tetrahedra,
                         double feature_budget = default_feature_budget,
                         const std::optional<SizingOptions>& near = {});

}  // namespace aeroloom::sizing
