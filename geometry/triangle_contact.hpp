/// Exact test whether two triangles of a surface intersect.
#pragma once

#include "geometry/vec.hpp"

namespace aeroloom::geometry {

/// The common corners of two triangles, up to three: corner first[k] of one is corner second[k] of the other.
struct CommonCorners {
  int count = 0;
  int first[3] = {}, second[3] = {};
};

/// Whether the closed triangles share a point outside their common corners and common side. True for three
/// common corners, and for a triangle of zero area with one that shares its side. Exact.
bool meet_wrongly(const Vec3 (&a)[3], const Vec3 (&b)[3], const CommonCorners& common);

/// The middle of what two triangles share, or of where they are nearest to each other. In floating point.
Vec3 place_of_meeting(const Vec3 (&a)[3], const Vec3 (&b)[3]);

}  // namespace aeroloom::geometry
