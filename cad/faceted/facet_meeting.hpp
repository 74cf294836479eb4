/// Whether two closed soups of triangles cross, or how near they come. Seen by cad/ only.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstdint>

namespace aeroloom::cad {

enum class FacetMeeting : std::uint8_t {
  apart,  ///< nowhere nearer than the clearance
  near,   ///< nearer, but no two triangles share a point
  crossing
};

struct MeetingPlace {
  FacetMeeting meeting = FacetMeeting::apart;
  geometry::Vec3 at;  ///< of the first triangles that are near or cross
};

/// Crossing exactly, nearness but for rounding.
MeetingPlace find_meeting(const FacetSoup& a, const FacetSoup& b, double clearance);

/// Whether one of the closed components of a soup encloses a point that is off them.
bool encloses(const FacetSoup& soup, geometry::Vec3 point);

}  // namespace aeroloom::cad
