/// Bounds of sizes that a user gives.
#pragma once

#include "sizing/field/size_field.hpp"

#include <optional>

namespace aeroloom::sizing {

/// Bounds that are given, members of SizingOptions; the others are chosen around them. Lengths in the model's
/// unit.
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

/// The options with what is given in place of their own; those of their bounds that contradict it follow. A
/// minimum brings that of features along (SizingOptions). Throws std::invalid_argument where what is given
/// contradicts itself.
SizingOptions with_given(const SizingOptions& options, const GivenSizes& given);

/// The purpose of a field: to make a mesh, or to tell what mesh that would be.
enum class FieldFor : bool { mesh, forecast };

}  // namespace aeroloom::sizing
