#include "cad/faceted/facet_facts.hpp"

#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_sides.hpp"

namespace aeroloom::cad {

FacetFacts look_at_facets(const FacetSoup& original) {
  FacetSoup soup = original;
  weld_equal_points(soup);
  FacetFacts facts;
  facts.format = soup.format;
  facts.points = static_cast<std::int32_t>(soup.points.size());
  facts.triangles = static_cast<std::int32_t>(soup.triangles.size());
  for (const FacetSoup::Group& group : soup.groups) facts.groups.push_back({group.name, group.part});
  facts.bounds = box_of_points(soup.points);
  const Vec3 base = facts.bounds.center();
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(soup, t);
    const double area = 0.5 * norm(area_vector2({a, b, c}));
    facts.area += area;
    facts.volume += geometry::volume6(base, a, b, c) / 6;
    facts.without_area += on_one_line(a, b, c);
    FacetGroupFacts& group = facts.groups[soup.group_of[t]];
    ++group.triangles;
    group.area += area;
  }
  for_each_side(sort_sides(soup.triangles), [&](std::span<const FacetSide> passes) {
    facts.open_sides += passes.size() == 1;
    facts.junction_sides += passes.size() > 2;
    facts.misoriented_sides += passes.size() == 2 && side_begin(soup.triangles, passes[0].half_edge) ==
                                                         side_begin(soup.triangles, passes[1].half_edge);
  });
  facts.components = find_components(soup).count;
  return facts;
}

}  // namespace aeroloom::cad
