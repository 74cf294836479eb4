/// How long a lifting body is behind its leading edge: the local chord, seen from its trailing edge.
#pragma once

#include "sizing/features/triangle_tree.hpp"

#include <array>
#include <vector>

namespace aeroloom::sizing {

/// A place on a trailing edge.
struct ChordPlace {
  geometry::Vec3 place;
  geometry::Vec3 along, into;  ///< unit: along the edge; from it into the body
  double width = 0;            ///< of the edge
};

/// The facets that cover a body around its trailing edge.
struct Skin {
  std::vector<Triangle> facets;
  std::vector<std::array<geometry::Vec3, 2>> border;  ///< segments where it ends: tips, roots
};

/// The shortest section through the place that leads round a nose, of those by planes across the edge that
/// are tilted by up to 40 degrees. Where all end on the skin's border (a box beam), how far the skin reaches
/// straight across the edge. 0 where there is no skin.
double local_chord(const Skin& skin, const ChordPlace& at);

}  // namespace aeroloom::sizing
