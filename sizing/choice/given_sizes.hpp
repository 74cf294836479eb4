/// Bounds of sizes that a user gives.
#pragma once

#include "sizing/field/size_field.hpp"

#include <optional>

namespace aeroloom::sizing {

/// The bounds that are given, members of SizingOptions. The others are chosen to fit them. Lengths are in the
/// unit of the model.
struct GivenSizes {
  std::optional<double> minimum, maximum;   ///< minimum <= maximum
  std::optional<double> feature_minimum;    ///< smallest size at short edges, narrow faces, sharp corners
  std::optional<double> surface_maximum;    ///< largest size on faces that are not far field
  std::optional<double> curvature_angle;    ///< degrees
  std::optional<double> chordal_deviation;  ///< of triangles from curved faces
  std::optional<double> growth;             ///< ratio of neighbouring sizes
  std::optional<double> proximity;          ///< elements across thin parts and gaps; 0: any
  std::optional<double> gap_proximity;      ///< across gaps alone

  /// Whether the sizes of features finer than the minimum are given too.
  bool holds_features() const { return minimum || feature_minimum; }
};

/// The options with the given bounds in place of their own. Bounds that contradict a given one follow it. A
/// given minimum also sets the sizes of features (SizingOptions). Throws std::invalid_argument where given
/// bounds contradict each other.
SizingOptions with_given(const SizingOptions& options, const GivenSizes& given);

/// The options of the field whose sizes are `factor` times as large everywhere (SizeField::scaled()):
/// lengths, the angle and the aspect times the factor, the deviation times its square, growth to its power,
/// elements across gaps divided by it.
SizingOptions at_scale(const SizingOptions& options, double factor);
/// The counts of that field.
PredictedCounts at_scale(const PredictedCounts& counts, double factor);

/// What a field is for: a mesh, or a forecast of the size of that mesh.
enum class FieldFor : bool { mesh, forecast };

}  // namespace aeroloom::sizing
