/// What features finer than the smallest size cost, and how fine they may be for a budget.
#pragma once

#include "sizing/model_sampler.hpp"
#include "sizing/size_field.hpp"

#include <cstdint>
#include <tuple>

namespace aeroloom::sizing {

/// Predicted elements over those without features finer than the minimum, at most, where nobody asks for
/// more.
inline constexpr double default_feature_budget = 5;

/// What strips, short edges and sharp corners bring that are finer than the minimum of some sizes.
struct FeatureShare {
  double floor = 0;      ///< the smallest size that strips may ask for; 0: the minimum
  double share = 1;      ///< predicted tetrahedra over those with the minimum as floor
  bool limited = false;  ///< by the budget: the floor is not the lowest
  double resolved_share =
      1;                 ///< about, with the lowest floor; as that of strips where it is within the budget
  double minimum = 0;    ///< of everything else
  double gap_floor = 0;  ///< as `floor`, of gaps
  double gap_share = 1;  ///< the part of `share` that these bring on top of the others

  static constexpr auto fields() {
    return std::tuple(&FeatureShare::floor, &FeatureShare::share, &FeatureShare::limited,
                      &FeatureShare::resolved_share, &FeatureShare::minimum, &FeatureShare::gap_floor,
                      &FeatureShare::gap_share);
  }
};

/// Lets strips ask for sizes down to `floor`, short edges and sharp corners, around which elements grow from
/// a point, down to that or a twentieth of the minimum; none of them for more than the minimum.
void set_feature_floor(SizingOptions& options, double floor);

/// Lets gaps ask for sizes down to `floor`.
void set_gap_floor(SizingOptions& options, double floor);

/// The lowest floors, that of gaps with what strips leave of the budget, down to a thousandth of the minimum,
/// with which the share is within the budget, under `options`, whose features ask for no less than their
/// minimum. By fields whose sizes are `coarser` times as large; those with clearly more leaves than
/// `most_leaves` count as far beyond the budget. Collective. Throws std::invalid_argument for a budget below
/// one.
FeatureShare share_of_features(const ModelSampler& sampler, const SizingOptions& options, double budget,
                               double coarser, std::int64_t most_leaves);

}  // namespace aeroloom::sizing
