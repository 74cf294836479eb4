#include "sizing/choice/feature_resolution.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/narrow_regions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

/// The finest size of a feature, over the minimum (docs/cad_repair.md). Chosen, not
/// measured.
constexpr double finest_over_minimum = 1e-3;
/// At short edges and sharp corners, over the minimum. Chosen, not measured.
constexpr double finest_point = 0.05;
/// Of the widest gap that was sewn: narrower features may be what sewing left. Chosen, not measured.
constexpr double finest_over_gap = 0.5;
// Of the budget: forecasts are 10 to 14 % too low where narrow regions take most of a mesh
// (docs/cad_repair.md).
constexpr double aim = 0.9;
// Values are tried on a logarithmic scale: steps of 4 %, up to a factor of a thousand.
constexpr int steps_per_octave = 16, last_step = 160;
/// Gaps that take more leaves than narrow regions may are counted by fields whose sizes are so many times as
/// large, with so many leaves at most.
constexpr double coarse_for_gaps = 4;
constexpr std::int64_t most_gap_leaves = 2'000'000;
// Tetrahedra around an element along one side of a narrow region: the first guess (twelve models: 40 to 90).
constexpr double tetrahedra_per_element = 60;

double at_step(int step) {
  return std::exp2(static_cast<double>(step) / steps_per_octave);
}

/// The finest step of a scale whose ratio is within the budget. Ratios fall from step to step, down to one
/// at the last, which stands for nothing.
class StepSearch {
public:
  using Count = std::function<std::optional<double>(int)>;

  /// `elements`: something that the tetrahedra which come on top are about proportional to, by step.
  StepSearch(Count count, std::vector<double> elements, double most)
      : _count(std::move(count)),
        _elements(std::move(elements)),
        _most(most),
        _found(static_cast<int>(_elements.size()) - 1),
        _finest_known(_found) {}

  /// `base`: tetrahedra of the last step; `per_element`: on top, a first guess, where there is one.
  void run(double base, std::optional<double> per_element) {
    _per_element = per_element.value_or(0) / base;
    if (_most < least_most) return;
    int low = -1;  // too fine
    int lame = 0;  // rounds that did not halve what is left
    while (_found - low > 1) {
      const int rest = _found - low;
      const int step = lame < most_lame_rounds ? guess(low) : low + rest / 2;
      const std::optional<double> tetrahedra = _count(step);
      const double ratio = tetrahedra ? *tetrahedra / base : 0;
      if (tetrahedra) learn(step, ratio);
      if (tetrahedra && ratio <= _most) {
        _found = step, _ratio = ratio;
      } else {
        low = step, _ratio_below = ratio;
      }
      lame = 2 * (_found - low) > rest + 1 ? lame + 1 : 0;
    }
  }

  int found() const { return _found; }
  double ratio() const { return _ratio; }
  /// Of the finest step, about where it was not tried.
  double finest_ratio() const { return _found == 0 ? _ratio : expected(0); }

private:
  static constexpr int most_lame_rounds = 2;  // guesses that lead nowhere, before halves are tried
  static constexpr double least_most = 1.01;  // a budget below it leaves features nothing

  double expected(int step) const { return 1 + _per_element * (_elements[step] - _elements.back()); }

  /// The finest step that should be within the budget, between those known.
  int guess(int low) const {
    int step = low + 1;
    while (step < _found - 1 && expected_between(step, low) > _most) ++step;
    return step;
  }

  /// Between two steps that were counted what comes on top goes by a power of the elements.
  double expected_between(int step, int low) const {
    const double last = _elements.back();
    if (low < 0 || !(_ratio_below > _ratio && _ratio > 1)) return expected(step);
    const double below = _elements[low] - last, above = _elements[_found] - last,
                 here = _elements[step] - last;
    if (!(below > above && above > 0)) return expected(step);
    const double power = std::log((_ratio_below - 1) / (_ratio - 1)) / std::log(below / above);
    return 1 + (_ratio - 1) * std::pow(here / above, power);
  }

  /// The finest step that was counted tells most of the narrow regions.
  void learn(int step, double ratio) {
    const double more = _elements[step] - _elements.back();
    if (step > _finest_known || !(more > 0)) return;
    _finest_known = step;
    _per_element = std::max(0.0, ratio - 1) / more;
  }

  Count _count;
  std::vector<double> _elements;
  double _most, _per_element = 0;
  int _found, _finest_known;
  double _ratio = 1, _ratio_below = 0;  // of the finest step within the budget, and of the next one tried
};

/// Predicts tetrahedra, and tells of it.
class Counter {
public:
  Counter(FieldFactory& factory, double coarsening, std::int64_t most_leaves)
      : _factory(factory), _coarsening(coarsening), _most_leaves(most_leaves) {}

  std::optional<double> operator()(const SizingOptions& options, const char* what, double value) const {
    const std::optional<double> tetrahedra = _factory.estimate_tetrahedra(options, _coarsening, _most_leaves);
    parallel::log_verbose(tetrahedra
                              ? fmt::format("sizing: {} {:.3g}: {:.3g} tetrahedra", what, value, *tetrahedra)
                              : fmt::format("sizing: {} {:.3g}: far too many", what, value));
    if (!tetrahedra) return std::nullopt;
    return std::max(1.0, *tetrahedra);
  }

private:
  FieldFactory& _factory;
  double _coarsening;
  std::int64_t _most_leaves;
};

/// Tetrahedra that are predicted without features, and with gaps alone.
struct Known {
  double base, with_gaps;
};

/// Fills in what narrow regions, short edges and sharp corners may ask for beside the gaps of the options.
void resolve_narrow_regions(FieldFactory& factory, const SizingOptions& options, double budget,
                            const Known& known, const Counter& count, FeatureResolution& found) {
  std::vector<double> aspects;
  aspects.reserve(last_step + 1);
  for (int step = 0; step < last_step; ++step) aspects.push_back(at_step(step));
  aspects.push_back(no_aspect);
  SizingOptions finest = options;
  set_feature_aspect(finest, 1, found.floor);
  StepSearch search(
      [&](int step) {
        SizingOptions tried = options;
        set_feature_aspect(tried, aspects[step], found.floor);
        return count(tried, "narrow regions at an aspect of", aspects[step]);
      },
      elements_along_narrow_regions(factory.sampled(), aspects, finest),
      1 + (aim * budget - 1) * known.base / known.with_gaps);
  search.run(known.with_gaps, tetrahedra_per_element);
  found.aspect = aspects[search.found()];
  found.limited = search.found() > 0;
  found.ratio = found.gap_ratio * search.ratio();
  found.resolved_ratio = found.gap_ratio * search.finest_ratio();
}

/// Fills in what gaps may ask for beside what was predicted to be `base`.
void resolve_gaps(SizingOptions options, double lowest, double budget, double base, const Counter& count,
                  FeatureResolution& found) {
  std::vector<double> floors{lowest}, elements{1 / lowest};
  for (int step = 0; step <= last_step; ++step) {
    const double floor = options.minimum / at_step(last_step - step);
    if (floor <= lowest) continue;
    floors.push_back(floor);
    elements.push_back(1 / floor);
  }
  StepSearch search(
      [&](int step) {
        set_gap_floor(options, floors[step]);
        return count(options, "gaps down to", floors[step]);
      },
      std::move(elements), aim * budget);
  search.run(base, {});
  found.gap_floor = floors[search.found()];
  found.gap_ratio = search.ratio();
  found.gaps_limited = search.found() > 0;
}

}  // namespace

double FeatureResolution::aspect_at(double width) const {
  const double size = aspect == no_aspect ? minimum : std::min(aspect * width, minimum);
  return std::max(size, floor) / width;
}

void set_feature_aspect(SizingOptions& options, double aspect, double floor) {
  options.narrow_minimum = aspect == no_aspect ? options.minimum : std::min(floor, options.minimum);
  options.feature_minimum = aspect == no_aspect
                                ? options.minimum
                                : std::max(options.narrow_minimum, finest_point * options.minimum);
  options.feature_aspect = aspect == no_aspect ? 1 : aspect;
}

void set_gap_floor(SizingOptions& options, double floor) {
  options.gap_minimum = std::min(floor, options.minimum);
}

void set_features(SizingOptions& options, const FeatureResolution& features) {
  if (features.floor > 0) set_feature_aspect(options, features.aspect, features.floor);
  if (features.gap_floor > 0) set_gap_floor(options, features.gap_floor);
}

FeatureResolution choose_feature_resolution(FieldFactory& factory, const SizingOptions& options,
                                            const FeatureBudget& budget, double coarsening,
                                            std::int64_t most_leaves) {
  if (!(budget.narrow >= 1)) {
    throw std::invalid_argument(
        fmt::format("sizing: feature_budget must be at least 1, but it is {}", budget.narrow));
  }
  FeatureResolution found;
  found.minimum = options.minimum;
  found.floor = std::min(options.minimum, std::max(finest_over_minimum * options.minimum,
                                                   finest_over_gap * factory.model().sewn_gap()));
  // A field that is so many times coarser has the cube of it fewer leaves where it is a volume's, and more
  // where narrow regions rule. Chosen, not measured.
  constexpr double slack = 4;
  const double leaves = std::min(1.0, slack / std::pow(coarsening, 3)) * static_cast<double>(most_leaves);
  const Counter usual(factory, coarsening, std::llround(leaves)),
      coarse(factory, coarse_for_gaps, most_gap_leaves);
  if (found.floor == options.minimum) return found;
  const double lowest = std::max(factory.gaps().narrowest_gap(), found.floor);
  const bool has_gaps = lowest < options.minimum && budget.gaps > 1;
  SizingOptions with_gaps = options;
  set_gap_floor(with_gaps, lowest);
  const bool is_large = has_gaps && !usual(with_gaps, "gaps down to", lowest);
  const Counter& count = is_large ? coarse : usual;
  const std::optional<double> base = count(options, "features down to", options.minimum);
  found.limited = !base;
  if (!base) return found;
  std::optional<double> counted = base;
  if (has_gaps) {
    resolve_gaps(options, lowest, budget.gaps, *base, count, found);
    set_gap_floor(with_gaps, found.gap_floor);
    counted = count(with_gaps, "gaps down to", found.gap_floor);
  }
  found.ratio = found.resolved_ratio = found.gap_ratio;
  found.limited = !counted;
  if (counted)
    resolve_narrow_regions(factory, has_gaps ? with_gaps : options, budget.narrow, {*base, *counted}, count,
                           found);
  return found;
}

}  // namespace aeroloom::sizing
