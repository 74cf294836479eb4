/// Intersection and distance of two closed triangle soups. Internal to cad/.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstdint>

namespace aeroloom::cad {

enum class FacetMeeting : std::uint8_t {
  apart,  ///< farther apart than the clearance
  near,   ///< nearer than the clearance, but without a common point
  crossing
};

struct MeetingPlace {
  FacetMeeting meeting = FacetMeeting::apart;
  geometry::Vec3 at;  ///< at the first triangles that are near or cross
};

/// Crossing is decided exactly, nearness up to rounding.
MeetingPlace find_meeting(const FacetSoup& a, const FacetSoup& b, double clearance);

/// Whether a closed component of the soup encloses the point, which must not lie on a triangle.
bool encloses(const FacetSoup& soup, geometry::Vec3 point);

}  // namespace aeroloom::cad
