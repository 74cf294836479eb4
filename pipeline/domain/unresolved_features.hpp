/// Reports features that are finer than the elements that the budget allows.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/choice/feature_resolution.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {
class SampledModel;
}

namespace aeroloom::domain {

/// A narrow region of a face where elements are longer than the region is wide.
struct UnresolvedRegion {
  std::string face;
  double width;            ///< smallest, in the model's unit
  geometry::Vec3 place;    ///< of the smallest width
  double surface_degrees;  ///< smallest angle to expect in a triangle across the region
};

/// Features finer than the smallest size and their resolution, if sizes were chosen from the model.
struct FeatureReport {
  sizing::FeatureResolution resolution;
  double tetrahedra = 0;                  ///< predicted total
  std::vector<UnresolvedRegion> regions;  ///< narrowest first; empty if all are resolved
  /// Approximate prediction with all narrow regions resolved.
  double wanted_tetrahedra() const;
};

/// Lists unresolved narrow regions. Collective.
FeatureReport report_features(const sizing::SampledModel& sampled,
                              const sizing::FeatureResolution& resolution, double tetrahedra);

/// A message about unresolved features: their cost, their effect, and remedies. Empty if there are none.
std::string describe(const FeatureReport& report);

/// A message about the elements that fine features add. Empty if they are few.
std::string describe_added(const FeatureReport& report);

}  // namespace aeroloom::domain
