/// Sizes that give a wanted number of tetrahedra.
#pragma once

#include "sizing/choice/feature_resolution.hpp"
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/given_sizes.hpp"
#include "sizing/field/size_field.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// Chosen sizes, the field they give, and the counts that the field predicts.
struct ChosenSizes {
  SizingOptions options;
  SizeField field;
  PredictedCounts counts;
  FeatureResolution features;
  double body_size;  ///< the size on the body, from which all bounds that are not given follow
  double aimed = 0;  ///< tetrahedra predicted without what comes on top of a target; 0: all of them
  /// The tetrahedra that a target counts.
  double counted() const { return aimed > 0 ? aimed : counts.tetrahedra; }
};

/// Of the target: what is left at least for everything but features where these take much.
inline constexpr double least_share = 0.4;

/// Sizes that give the target within some twenty percent, by estimates alone
/// (FieldFactory::estimate_tetrahedra). No feature is finer than the minimum. Collective. Throws as
/// choose_sizes().
SizingOptions estimate_sizes(FieldFactory& factory, double target_tetrahedra, const GivenSizes& given = {});

/// Sizes estimated by coarse fields, before a field is built that is as fine as asked for.
struct PreliminarySizes {
  SizingOptions options;          ///< where no feature is finer than the minimum
  double body_size;               ///< as in ChosenSizes
  bool is_out_of_reach;           ///< nothing came near the target
  bool is_infeasible;             ///< the given bounds take many times the target
  FeatureResolution features;     ///< none are chosen if sizes of features are given
  double base;                    ///< elements predicted without features, for which these are chosen
  double aimed;                   ///< elements that the field is to have, features included
  double target, feature_budget;  ///< as asked for
  /// `options` with the sizes of features.
  SizingOptions with_features() const;
};

/// Finds sizes for a wanted number of tetrahedra. All bounds that are not given follow from one length, the
/// size on the body. The search varies it until the predicted count is within some percent of the target. The
/// target counts everything but what requests ask for in regions and wakes. At least two fifths of it are
/// left for what is not a feature finer than the minimum; if features take more, they may make it up to
/// `feature_budget` times the target, and get less where the coarsest sizes leave no room for that. Gaps get
/// elements as small as they are wide whatever the target, within ten million elements and 500 times the
/// target; a quarter of the target is left then. If the target is out of reach, the nearest sizes are chosen.
/// `near`: sizes of nearly the same model, to start from. The factory must look for gaps as closely as the
/// options ask, or not at all. Collective. Throws std::invalid_argument for a target below one.
ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra,
                         double feature_budget = default_feature_budget,
                         const std::optional<SizingOptions>& near = {}, const GivenSizes& given = {});

/// The first half of choose_sizes(): preliminary sizes. Collective.
PreliminarySizes preliminary_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                                   const std::optional<SizingOptions>& near, const GivenSizes& given);

/// The sizes by which it is judged whether trailing edges are kept: those where everything but features meets
/// the target, and features make it up to five times as many, or up to a larger budget. Collective.
SizingOptions sizes_for_edges(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                              const PreliminarySizes& preliminary, const GivenSizes& given);

/// If more elements than this are predicted, a forecast uses a coarse field
/// (FieldFactory::build_coarse_field).
inline constexpr double least_coarse_forecast = 3e7;

/// The second half of choose_sizes(): the field. Collective.
ChosenSizes choose_sizes(FieldFactory& factory, const PreliminarySizes& preliminary, const GivenSizes& given,
                         FieldFor purpose = FieldFor::mesh);

/// Whether sizes of a choice grow faster than the preset's: forecasts may be off by more than a quarter then.
bool is_steep(const SizingOptions& chosen);

/// The least target that the model meets, about, where the chosen sizes give more than was aimed at.
double least_target(const ChosenSizes& chosen);

/// The field of given sizes and its predicted counts. If the mesh will be so large that the field takes long,
/// the log first says how large. Collective.
ChosenSizes apply_sizes(FieldFactory& factory, const SizingOptions& options, FieldFor purpose);

/// BoundCost::bound for what features finer than a given minimum cost.
inline constexpr const char* of_features = "features";

/// The effect of one given bound on the number of tetrahedra.
struct BoundCost {
  std::string bound;  ///< its name in SizingOptions, or of_features
  double ratio;       ///< about the tetrahedra over those without the bound; infinite: far too many
};

/// The cost of each given bound, by coarse fields. Collective.
std::vector<BoundCost> costs_of_given(FieldFactory& factory, const ChosenSizes& chosen,
                                      const GivenSizes& given);

}  // namespace aeroloom::sizing
