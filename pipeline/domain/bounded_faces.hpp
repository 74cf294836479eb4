/// Reports faces where the smallest size prevents elements as small as curvature needs.
#pragma once

#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {
class FieldFactory;
}

namespace aeroloom::domain {

/// Faces of one name whose elements exceed the wanted curvature angle or chordal deviation.
struct NamedBound {
  std::string face;
  double fraction;       ///< of the area of these faces
  double degrees;        ///< largest angle between normals across an element; 180 at most
  double body_fraction;  ///< the bounded area over the area of the body
};

/// The bounded faces of a model, largest fractions first. Collective.
std::vector<NamedBound> report_bounded_faces(sizing::FieldFactory& factory,
                                             const sizing::SizingOptions& sizes);

/// One line about the first few; empty if they cover little area.
std::string describe(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes);

/// One sentence where the shape is lost: elements turn by a right angle or more, or much of the body is
/// bounded. Empty elsewhere.
std::string warning_of(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes);

}  // namespace aeroloom::domain
