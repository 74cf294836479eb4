/// The cost of features finer than the smallest size, and how fine they may be for a budget.
#pragma once

#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <limits>
#include <tuple>

namespace aeroloom::sizing {

class FieldFactory;

/// Predicted elements over those without features finer than the minimum, at most, where nobody asks for
/// more.
inline constexpr double default_feature_budget = 5;

/// Of strips whose elements get nothing below the minimum.
inline constexpr double no_aspect = std::numeric_limits<double>::infinity();

/// The elements that strips, short edges and sharp corners bring which are finer than the minimum of some
/// sizes. Strips share one aspect: for the same number of elements thin and thick ones have the same angles.
struct FeatureShare {
  double aspect = no_aspect;  ///< length of an element over the strip's width there; 1: resolved
  double floor = 0;           ///< however thin, none asks for less
  double share = 1;           ///< predicted tetrahedra over those where nothing is finer than the minimum
  bool limited = false;       ///< by the budget: strips are not resolved
  double resolved_share = 1;  ///< as `share`, about, if strips were resolved
  double minimum = 0;         ///< of everything else
  double gap_floor = 0;       ///< the smallest size that gaps may ask for; 0: the minimum
  double gap_share = 1;       ///< the part of `share` that these bring on top of the others

  static constexpr auto fields() {
    return std::tuple(&FeatureShare::aspect, &FeatureShare::floor, &FeatureShare::share,
                      &FeatureShare::limited, &FeatureShare::resolved_share, &FeatureShare::minimum,
                      &FeatureShare::gap_floor, &FeatureShare::gap_share);
  }
  /// Of the elements along a strip of that width.
  double aspect_at(double width) const;
};

/// Lets strips ask for sizes down to `floor` at that aspect, and short edges and sharp corners, around which
/// elements grow from a point, for sizes down to that or a twentieth of the minimum; none of them for more
/// than the minimum. Of no_aspect nothing is finer than the minimum.
void set_feature_aspect(SizingOptions& options, double aspect, double floor);

/// Lets gaps ask for sizes down to `floor`.
void set_gap_floor(SizingOptions& options, double floor);

/// Sets aspect and floors as they were found.
void set_features(SizingOptions& options, const FeatureShare& features);

/// The least aspect, and then, with what that leaves of the budget, the lowest floor of gaps, with which the
/// share is within the budget, under `options`, whose features ask for no less than their minimum. Of
/// logarithmic scales of values, the finest one that is within it: a larger budget never makes anything
/// coarser. No size is finer than a thousandth of the minimum. By fields whose sizes are `coarser` times as
/// large; those with clearly more leaves than `most_leaves` count as beyond any budget. Collective. Throws
/// std::invalid_argument for a budget below one.
FeatureShare share_of_features(FieldFactory& factory, const SizingOptions& options, double budget,
                               double coarser, std::int64_t most_leaves);

}  // namespace aeroloom::sizing
