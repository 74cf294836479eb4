// Lengths of a case from multiples of its reference length to the model's unit.
#include "pipeline/case/case.hpp"

#include <optional>

namespace aeroloom::cases {

namespace {

void scale(std::optional<double>& length, double unit) {
  if (length) *length *= unit;
}

void scale(std::optional<geometry::Vec3>& place, double unit) {
  if (place) *place = unit * *place;
}

}  // namespace

SizingRequest in_model_units(const SizingRequest& request) {
  SizingRequest result = request;
  const double unit = request.reference_length.value_or(1);
  for (std::optional<double>* size : {&result.minimum, &result.maximum, &result.feature_minimum,
                                      &result.surface_maximum, &result.chordal_deviation})
    scale(*size, unit);
  for (sizing::PatchSize& patch : result.patch_sizes) patch.size *= unit;
  for (SourceRule& rule : result.sources) {
    rule.shape = scaled(rule.shape, unit);
    rule.size *= unit;
  }
  for (WallRule& rule : result.walls) scale(rule.size, unit), scale(rule.distance, unit);
  for (EdgeRule& rule : result.edges) {
    scale(rule.size, unit), scale(rule.height, unit);
    scale(rule.low, unit), scale(rule.high, unit);
  }
  return result;
}

}  // namespace aeroloom::cases
