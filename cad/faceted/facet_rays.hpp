/// Which closed shells of triangles enclose a point: by the triangles that a ray from it passes. Seen by this
/// folder only.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "geometry/box_tree.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

class FacetRays {
public:
  explicit FacetRays(const FacetSoup& soup);

  /// Numbers of the triangles that a ray from the point passes, ascending. It begins on the side of triangle
  /// `from` that `direction` points to, or off all triangles with from = -1. Exact, but for where the ray
  /// begins; turned a little where it meets a side or a point.
  std::vector<std::int32_t> passed(geometry::Vec3 point, std::int32_t from, geometry::Vec3 direction) const;

private:
  bool collect(geometry::Vec3 point, geometry::Vec3 end, std::int32_t from,
               std::vector<std::int32_t>& found) const;

  const FacetSoup& _soup;
  geometry::BoxTree _tree;
  double _reach = 0;
};

}  // namespace aeroloom::cad
