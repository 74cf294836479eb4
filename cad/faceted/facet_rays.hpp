/// Casts rays through triangles, to decide which closed shells enclose a point. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "geometry/box_tree.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

class FacetRays {
public:
  explicit FacetRays(const FacetSoup& soup);

  /// Numbers of the triangles that a ray from the point crosses, ascending. If the point lies on triangle
  /// `from`, the ray starts on the side to which `direction` points; -1: it lies on no triangle. The ray is
  /// turned a little if it meets a side or a corner. Exact, apart from the start of the ray.
  std::vector<std::int32_t> passed(geometry::Vec3 point, std::int32_t from, geometry::Vec3 direction) const;

private:
  bool collect(geometry::Vec3 point, geometry::Vec3 end, std::int32_t from,
               std::vector<std::int32_t>& found) const;

  const FacetSoup& _soup;
  geometry::BoxTree _tree;
  double _reach = 0;
};

}  // namespace aeroloom::cad
