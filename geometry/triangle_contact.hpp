/// The exact decision whether two triangles of a surface meet where they must not.
#pragma once

#include "geometry/vec.hpp"

namespace aeroloom::geometry {

/// The corners, 0 to 2, that two triangles have in common: first[k] of one is second[k] of the other.
struct CommonCorners {
  int count = 0;
  int first[3] = {}, second[3] = {};
};

/// Whether the closed triangles share a point outside their common corners and side. Two triangles with three
/// common corners do; so does a triangle without area with one that shares a side with it. Exact.
bool meet_wrongly(const Vec3 (&a)[3], const Vec3 (&b)[3], const CommonCorners& common);

}  // namespace aeroloom::geometry
