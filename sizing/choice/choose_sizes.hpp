/// Sizes that give a wanted number of tetrahedra.
#pragma once

#include "sizing/choice/feature_share.hpp"
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/given_sizes.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// Sizes with the field they give and the counts that field predicts.
struct ChosenSizes {
  SizingOptions options;
  SizeField field;
  PredictedCounts counts;
  FeatureShare features;
  double body_size;  ///< from which the bounds that are not given follow
};

/// Sizes that give the target within some twenty percent, by estimates alone
/// (FieldFactory::estimate_tetrahedra), where no feature is finer than their minimum. Collective. Throws as
/// choose_sizes().
SizingOptions estimate_sizes(FieldFactory& factory, double target_tetrahedra, const GivenSizes& given = {});

/// Sizes as coarse fields foretell them, before any is built that is as fine as asked for.
struct Prospect {
  SizingOptions options;  ///< where no feature is finer than the minimum
  double body_size;       ///< from which the bounds that are not given follow
  bool is_out_of_reach;   ///< nothing came near the target
  bool is_hopeless;       ///< what is given takes many times as many
  FeatureShare features;  ///< as given options have them where features' sizes are given
  /// `options` with what features ask for.
  SizingOptions with_features() const;
};

/// Searches the one size from which all bounds that are not given follow until the predicted count is within
/// some percent of the target where no feature asks for less than the minimum. What finer features ask for
/// comes on top, up to `feature_budget` times the target in all: the rest of the model has the sizes it would
/// have without them; where their sizes are given, the target is for all together. What comes nearest is
/// chosen where the target is out of reach. The search starts at `near`, sizes for a model that is almost the
/// same, where there are such. The factory must look for gaps as closely as the options ask, or not at all.
/// Collective. Throws std::invalid_argument for a target below one.
ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra,
                         double feature_budget = default_feature_budget,
                         const std::optional<SizingOptions>& near = {}, const GivenSizes& given = {});

/// The first half of that. Collective.
Prospect prospect_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                        const std::optional<SizingOptions>& near, const GivenSizes& given);

/// The field of a forecast is a rough one (FieldFactory::build_rough_field) where there would be more
/// elements than this.
inline constexpr double least_rough = 3e7;

/// The second half. Collective.
ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra, const Prospect& prospect,
                         const GivenSizes& given, FieldFor purpose = FieldFor::mesh);

/// The field of given sizes and what it predicts. Where it is for a mesh of so many elements that it takes
/// long, the log says first how many. Collective.
ChosenSizes apply_sizes(FieldFactory& factory, const SizingOptions& options, FieldFor purpose);

/// Where the minimum is given and does not bind them.
inline constexpr const char* of_features = "features";

/// The effect of one of the given bounds.
struct BoundCost {
  std::string bound;  ///< its name in SizingOptions; of_features for what features finer than the minimum do
  double ratio;  ///< predicted tetrahedra over those with what would be chosen in its place, about; infinite
                 ///< where there are far too many
};

/// Of each that is given, by coarse fields. Collective.
std::vector<BoundCost> costs_of_given(FieldFactory& factory, const ChosenSizes& chosen,
                                      const GivenSizes& given);

}  // namespace aeroloom::sizing
