// Fields of what a sampler finds, as fine as asked for and coarser.
#include "sizing/choice/model_sampler.hpp"
#include "sizing/field/field_builder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aeroloom::sizing {
namespace {

/// Sizes that differ by rounding alone.
bool is_same(double a, double b) {
  constexpr double rounding = 1e-9;  // relative
  return std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b));
}

/// Cells that demands ask for over leaves, from which on a field has clearly more leaves: cells may lie in
/// several regions, and are counted with some to spare.
constexpr double most_cells_per_leaf = 4;

bool are_same_sizes(const SizingOptions& a, const SizingOptions& b) {
  return is_same(a.minimum, b.minimum) && is_same(a.maximum, b.maximum) &&
         is_same(a.surface_maximum, b.surface_maximum) && is_same(a.growth, b.growth) &&
         is_same(a.curvature_angle, b.curvature_angle) && is_same(a.proximity, b.proximity) &&
         is_same(elements_across_gaps(a), elements_across_gaps(b)) &&
         is_same(a.chordal_deviation, b.chordal_deviation) && is_same(a.feature_aspect, b.feature_aspect) &&
         is_same(smallest_feature_size(a), smallest_feature_size(b)) &&
         is_same(smallest_strip_size(a), smallest_strip_size(b)) &&
         is_same(smallest_gap_size(a), smallest_gap_size(b));
}

}  // namespace

SizeField ModelSampler::build_field(const SizingOptions& options) {
  return FieldBuilder(_communicator, _model.bounds(), options).build(sample(options, 1));
}

std::optional<SizeField> ModelSampler::build_coarser(const SizingOptions& options, double coarser,
                                                     std::int64_t most_leaves) {
  if (demands_more_cells(options, coarser, most_cells_per_leaf * static_cast<double>(most_leaves)))
    return std::nullopt;
  SizingOptions coarse = options;
  for (double* size : {&coarse.minimum, &coarse.feature_minimum, &coarse.strip_minimum, &coarse.gap_minimum,
                       &coarse.surface_maximum, &coarse.maximum})
    *size *= coarser;
  if (coarser > 1) coarse.growth = std::min(std::pow(options.growth, coarser), largest_growth);
  return FieldBuilder(_communicator, _model.bounds(), coarse)
      .build_within(sample(options, coarser), most_leaves);
}

std::optional<Trial> ModelSampler::try_sizes(const SizingOptions& options, std::int64_t most_leaves) {
  std::optional<SizeField> field = build_coarser(options, 1, most_leaves);
  if (!field) return std::nullopt;
  const double tetrahedra = count_tetrahedra(*field);
  return Trial{std::move(*field), tetrahedra};
}

std::optional<double> ModelSampler::estimate_tetrahedra(const SizingOptions& options, double coarser,
                                                        std::int64_t most_leaves) {
  const auto known = std::find_if(_estimates.begin(), _estimates.end(), [&](const Estimate& each) {
    return each.coarser == coarser && are_same_sizes(each.options, options);
  });
  if (known != _estimates.end())
    return known->leaves > most_leaves ? std::nullopt : std::optional(known->tetrahedra);
  const std::optional<SizeField> field = build_coarser(options, coarser, most_leaves);
  if (!field) return std::nullopt;
  const double tetrahedra = std::pow(coarser, 3) * count_tetrahedra(*field);
  _estimates.push_back({options, coarser, field->leaf_count(), tetrahedra});
  return tetrahedra;
}

SizeField build_size_field(const parallel::Communicator& communicator, const cad::Model& model,
                           const SizingOptions& options) {
  check_options(options);
  const double layers = std::max(options.proximity, elements_across_gaps(options));
  return ModelSampler(communicator, model, layers, Fields::one).build_field(options);
}

}  // namespace aeroloom::sizing
