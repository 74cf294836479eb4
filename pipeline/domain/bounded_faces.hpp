/// Where the smallest size wins over what curvature asks for.
#pragma once

#include "sizing/field/size_field.hpp"

#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {
class FieldFactory;
}

namespace aeroloom::domain {

/// Faces of one name on which elements turn further, or lie farther off, than was asked for.
struct NamedBound {
  std::string face;
  double fraction;       ///< of their area
  double degrees;        ///< that an element turns there, at most; 180 where it would turn further
  double share_of_body;  ///< the area in question over that of the whole body

  static constexpr auto fields() {
    return std::tuple(&NamedBound::face, &NamedBound::fraction, &NamedBound::degrees,
                      &NamedBound::share_of_body);
  }
};

/// The bounded faces of a model, the largest fractions first. Collective.
std::vector<NamedBound> report_bounded_faces(sizing::FieldFactory& factory,
                                             const sizing::SizingOptions& sizes);

/// One line of a few of them; empty where there are none of any extent.
std::string describe(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes);

/// Whether that is so on much of the body: its shape is lost, or what was asked for has little effect.
bool is_much_of_body(const std::vector<NamedBound>& faces);

}  // namespace aeroloom::domain
