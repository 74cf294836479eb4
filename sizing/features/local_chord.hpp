/// The local chord of a lifting body: its length from the trailing to the leading edge.
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

/// The facets of the skin of a body around its trailing edge.
struct Skin {
  std::vector<Triangle> facets;
  std::vector<std::array<geometry::Vec3, 2>> border;  ///< segments where it ends: tips, roots
};

/// The local chord at a place. Sections are cut by planes across the edge, tilted by up to 40 degrees. The
/// shortest one that goes round a nose counts. If all end on the border of the skin (a box beam), it is the
/// length of the skin straight across the edge. Zero without a skin.
double local_chord(const Skin& skin, const ChordPlace& at);

}  // namespace aeroloom::sizing
