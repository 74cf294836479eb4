/// Features that are finer than the elements which the budget has for them.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/choice/feature_resolution.hpp"

#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {
class SampledModel;
}

namespace aeroloom::domain {

/// A strip of a face across which elements are shorter than along it.
struct UnresolvedStrip {
  std::string face;
  double width;            ///< at the narrowest place, in the model's unit
  geometry::Vec3 place;    ///< there
  double surface_degrees;  ///< the angle of triangles to expect: one side is the width, one the floor

  static constexpr auto fields() {
    return std::tuple(&UnresolvedStrip::face, &UnresolvedStrip::width, &UnresolvedStrip::place,
                      &UnresolvedStrip::surface_degrees);
  }
};

/// Features finer than the smallest size, and how far they are resolved, where sizes were chosen from the
/// model.
struct FeatureReport {
  sizing::FeatureResolution share;
  double tetrahedra = 0;                ///< predicted in all
  std::vector<UnresolvedStrip> strips;  ///< narrowest first; empty where everything is resolved

  static constexpr auto fields() {
    return std::tuple(&FeatureReport::share, &FeatureReport::tetrahedra, &FeatureReport::strips);
  }
  /// Predicted tetrahedra with every strip resolved; about that.
  double wanted_tetrahedra() const;
};

/// Lists the strips. Collective.
FeatureReport report_features(const sizing::SampledModel& sampled, const sizing::FeatureResolution& share,
                              double tetrahedra);

/// The message about unresolved features: what they would take, what to expect, and the remedies; empty where
/// there are none.
std::string describe(const FeatureReport& report);

/// The message about what features finer than the smallest size add to the count; empty where it is little.
std::string describe_share(const FeatureReport& report);

}  // namespace aeroloom::domain
