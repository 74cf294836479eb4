/// How finely features below the smallest size are resolved, and what that costs.
#pragma once

#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <limits>

namespace aeroloom::sizing {

class FieldFactory;

/// The most elements over those aimed at, for features that do not fit into the target.
inline constexpr double default_feature_budget = 1.3;

/// The aspect of narrow regions whose elements are nowhere smaller than the minimum.
inline constexpr double no_aspect = std::numeric_limits<double>::infinity();

/// Features that are finer than the minimum: narrow regions of faces, short edges, sharp corners and gaps.
/// All narrow regions share one aspect, the length of an element over the width of the region. So for the
/// same number of elements, thin and thick regions get the same angles.
struct FeatureResolution {
  double aspect = no_aspect;  ///< length of an element over the width of a narrow region; 1: resolved
  double floor = 0;           ///< none asks for less, however narrow
  double ratio = 1;           ///< predicted tetrahedra over those where nothing is finer than the minimum
  bool limited = false;       ///< by the budget: narrow regions are not resolved
  bool gaps_limited = false;  ///< by the budget: some gaps have less than one element across
  double resolved_ratio = 1;  ///< as `ratio`, about, if narrow regions were resolved
  double minimum = 0;         ///< of everything else
  double gap_floor = 0;       ///< the smallest size that gaps may ask for; 0: the minimum
  double gap_ratio = 1;       ///< the factor of `ratio` that is due to gaps
  /// The aspect of elements in a narrow region of that width.
  double aspect_at(double width) const;
};

/// Sets the aspect of narrow regions and the smallest size that they may ask for, `floor`. Short edges and
/// sharp corners may ask for sizes down to `floor` or a twentieth of the minimum, whichever is larger:
/// elements grow around them from a point. With no_aspect nothing is finer than the minimum.
void set_feature_aspect(SizingOptions& options, double aspect, double floor);

/// Sets the smallest size that gaps may ask for.
void set_gap_floor(SizingOptions& options, double floor);

/// Sets aspect and smallest sizes as they were found.
void set_features(SizingOptions& options, const FeatureResolution& features);

/// What features may add. Both are predicted elements over those where nothing is finer than the minimum.
struct FeatureBudget {
  double narrow;    ///< for narrow regions, short edges and sharp corners; gaps do not count. At least 1
  double gaps = 1;  ///< for gaps; 1: none is resolved further
};

/// First chooses the smallest size of gaps that fits their budget, then the smallest aspect that fits its
/// own. `options` must not allow features below the minimum. Values are tried on logarithmic scales, so a
/// larger budget never makes anything coarser. No size is finer than a thousandth of the minimum. Counts come
/// from fields whose sizes are `coarsening` times as large. A field with clearly more leaves than
/// `most_leaves` counts as beyond any budget; gaps are then counted by coarser fields. Collective. Throws
/// std::invalid_argument for a budget below one.
FeatureResolution choose_feature_resolution(FieldFactory& factory, const SizingOptions& options,
                                            const FeatureBudget& budget, double coarsening,
                                            std::int64_t most_leaves);

}  // namespace aeroloom::sizing
