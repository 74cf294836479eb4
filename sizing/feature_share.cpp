#include "sizing/feature_share.hpp"

#include "parallel/log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

constexpr double finest_over_minimum = 1e-3;
constexpr double finest_point = 0.05;    // of the minimum, at short edges and sharp corners
constexpr double finest_over_gap = 0.5;  // of the widest gap that was sewn
// Of the budget: what is aimed at, and what is near enough to it.
constexpr double aim = 0.93, well_used = 0.85;
constexpr int bisection_rounds = 8;
constexpr double same_floor = 0.05;  // logarithm of two floors that are as good as equal
// Fields that are coarser have so many times fewer leaves, at most.
constexpr double slack = 4;

/// Tries floors between one that is certainly within the budget and one that is not.
class FloorSearch {
public:
  using SetFloor = void (*)(SizingOptions&, double);

  FloorSearch(const ModelSampler& sampler, const SizingOptions& options, SetFloor set_floor, double budget,
              double coarser, std::int64_t most_leaves)
      : _sampler(sampler),
        _options(options),
        _set_floor(set_floor),
        _budget(budget),
        _coarser(coarser),
        _most_leaves(
            std::llround(std::min(1.0, slack / std::pow(coarser, 3)) * static_cast<double>(most_leaves))) {}

  /// Nothing is finer than `finest`. `base`: what is predicted without features, where that is known.
  FeatureShare run(double finest, std::optional<double> base = {}) {
    FeatureShare found{_options.minimum, 1, false, 1, _options.minimum, _options.minimum};
    const double lowest =
        std::min(_options.minimum, std::max({finest, finest_over_minimum * _options.minimum,
                                             finest_over_gap * _sampler.model().sewn_gap()}));
    if (lowest == _options.minimum) return found;
    if (!base) base = count(_options.minimum);
    _tetrahedra = base;
    if (!base) {
      found.limited = true;
      return found;
    }
    double low = lowest, high = _options.minimum, floor = lowest;
    Known known{_options.minimum, 1};
    for (int round = 0; round < bisection_rounds && std::log(high / low) > same_floor; ++round) {
      const std::optional<double> tetrahedra = count(floor);
      const double share = tetrahedra ? *tetrahedra / *base : 0;
      if (tetrahedra && floor < known.floor) known = {floor, share};
      if (tetrahedra && share <= _budget) {
        found.floor = high = floor;
        found.share = share;
        _tetrahedra = tetrahedra;
        if (floor == lowest || share >= well_used * _budget) break;
      } else {
        low = floor;
      }
      // Strips ask for elements in proportion to 1 / floor.
      floor = tetrahedra ? floor * (share - 1) / (aim * _budget - 1) : 0;
      if (!(floor > low && floor < high)) floor = std::sqrt(low * high);
    }
    found.limited = found.floor > lowest;
    found.resolved_share = found.limited ? share_at(lowest, known) : found.share;
    return found;
  }

  /// Predicted with what was found.
  std::optional<double> tetrahedra() const { return _tetrahedra; }

private:
  /// A floor for which tetrahedra were predicted.
  struct Known {
    double floor, share;
  };

  /// The share of a lower floor, about. Sizes grow away from a strip at the same rate, whatever they start
  /// from: around each element along it there are as many tetrahedra, large or small.
  double share_at(double floor, const Known& known) const {
    const std::array<double, 3> floors{floor, known.floor, _options.minimum};
    const std::vector<double> elements = _sampler.elements_along_strips(floors, _options.minimum);
    const double more = elements[0] - elements[2], known_more = elements[1] - elements[2];
    return known_more > 0 ? 1 + (known.share - 1) * more / known_more : known.share;
  }

  std::optional<double> count(double floor) const {
    SizingOptions options = _options;
    _set_floor(options, floor);
    const std::optional<double> tetrahedra = _sampler.estimate_tetrahedra(options, _coarser, _most_leaves);
    parallel::log_verbose(
        tetrahedra ? fmt::format("sizing: features down to {:.3g}: {:.3g} tetrahedra", floor, *tetrahedra)
                   : fmt::format("sizing: features down to {:.3g}: far too many", floor));
    if (!tetrahedra) return std::nullopt;
    return std::max(1.0, *tetrahedra);
  }

  const ModelSampler& _sampler;
  SizingOptions _options;
  SetFloor _set_floor;
  double _budget, _coarser;
  std::int64_t _most_leaves;
  std::optional<double> _tetrahedra;
};

}  // namespace

void set_feature_floor(SizingOptions& options, double floor) {
  options.strip_minimum = std::min(floor, options.minimum);
  options.feature_minimum = std::max(options.strip_minimum, finest_point * options.minimum);
}

void set_gap_floor(SizingOptions& options, double floor) {
  options.gap_minimum = std::min(floor, options.minimum);
}

FeatureShare share_of_features(const ModelSampler& sampler, const SizingOptions& options, double budget,
                               double coarser, std::int64_t most_leaves) {
  if (!(budget >= 1)) {
    throw std::invalid_argument(
        fmt::format("sizing: feature_budget must be at least 1, but it is {}", budget));
  }
  FloorSearch search(sampler, options, set_feature_floor, budget, coarser, most_leaves);
  FeatureShare found = search.run(0);
  if (sampler.narrowest_gap() >= options.minimum || found.share >= well_used * budget) return found;
  SizingOptions with_strips = options;
  set_feature_floor(with_strips, found.floor);
  const FeatureShare of_gaps =
      FloorSearch(sampler, with_strips, set_gap_floor, budget / found.share, coarser, most_leaves)
          .run(sampler.narrowest_gap(), search.tetrahedra());
  found.gap_floor = of_gaps.floor;
  found.gap_share = of_gaps.share;
  found.share *= of_gaps.share;
  return found;
}

}  // namespace aeroloom::sizing
