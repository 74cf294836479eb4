// Fields of sizes that ask for more elements than anyone would build a field for to be told so.
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/field/field_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace aeroloom::sizing {
namespace {

/// Leaves of a field that only tells how many elements there would be, and parts of faces for each of them.
/// Chosen, not measured.
constexpr std::int64_t most_leaves = 300'000;
constexpr double rough_parts_per_leaf = 4;
/// Sizes over those asked for: of the first field, and of the last, which is built whatever it takes.
constexpr double first_coarsening = 4, coarsest = 4096;

/// The number of tetrahedra that a field predicts over that of one whose sizes are `coarsening` times as
/// large. Over an area A of a wall with sizes h there are A / h^2 times the thickness, in sizes, of what
/// leaves around sources keep at h, which sizes make as many times thicker, and 1 / (2 s) for what lies
/// beyond, where sizes grow by s a length: the integral of h^2 / (h + s d)^3. The thickness is such that
/// fields with sizes four times as large have the bias that was measured (0.55: median of seven models).
double bias_of(double coarsening, double growth) {
  constexpr double thickness = 0.71;  // as said above
  const double slope = std::log(growth), coarse = std::min(slope, std::log(largest_growth) / coarsening);
  return (thickness + 0.5 / slope) / (thickness * coarsening + 0.5 / coarse);
}

}  // namespace

CoarseField FieldFactory::build_coarse_field(const SizingOptions& options) {
  for (double coarsening = first_coarsening;; coarsening *= 2) {
    const bool last = coarsening >= coarsest;
    const double most_parts =
        rough_parts_per_leaf * coarsening * coarsening * static_cast<double>(most_leaves);
    if (!last && has_more_parts(options, most_parts)) continue;
    std::optional<SizeField> field = build_coarser(
        options, coarsening, Requests::all, last ? std::numeric_limits<std::int64_t>::max() : most_leaves);
    if (!field) continue;
    PredictedCounts counts{std::pow(coarsening, 2) * count_triangles(_sampled, *field),
                           std::pow(coarsening, 3) * count_tetrahedra(_sampled, *field)};
    counts.tetrahedra *= bias_of(coarsening, options.growth);
    return {field->scaled(1 / coarsening), counts};
  }
}

}  // namespace aeroloom::sizing
