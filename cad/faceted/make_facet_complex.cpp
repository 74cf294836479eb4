#include "cad/faceted/make_facet_complex.hpp"

#include "cad/faceted/chambers.hpp"
#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/features.hpp"
#include "cad/faceted/unite_components.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/place_text.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

void refuse_contacts(const FacetSoup& soup) {
  const FacetComponents components = find_components(soup);
  const FacetContacts contacts = find_facet_contacts(soup, components);
  if (contacts.pairs == 0) return;
  const std::string place = geometry::place_text(middle_of(soup, contacts.first));
  if (components.of[contacts.first] != components.of[contacts.second]) {
    throw CadError(
        fmt::format("{}: {} and {} overlap or touch at {} ({} pairs of triangles in all); unite them in the "
                    "CAD program, or "
                    "move them apart",
                    soup.file, component_name(soup, components, contacts.first),
                    component_name(soup, components, contacts.second), place, contacts.pairs));
  }
  throw CadError(
      fmt::format("{}: the surface crosses or touches itself at {}, in {} pairs of triangles; repair it "
                  "there and export it again",
                  soup.file, place, contacts.pairs));
}

/// Chambers that are no material and from which no way leads outside, over triangles between two of them.
std::vector<char> enclosed_voids(const Chambers& chambers) {
  geometry::DisjointSets<std::int32_t> spaces(chambers.chambers.size());
  for (const auto& [ahead, behind] : chambers.beside) {
    if (!chambers.chambers[ahead].filled && !chambers.chambers[behind].filled) spaces.unite(ahead, behind);
  }
  std::vector<char> enclosed;
  enclosed.reserve(spaces.size());
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(spaces.size()); ++c)
    enclosed.push_back(!chambers.chambers[c].filled && spaces.root(c) != 0);
  return enclosed;
}

/// Leaves out triangles between two spaces that are no material, and turns the others so that their normals
/// point out of `front`.
std::vector<FacetRegions> orient_facets(FacetSoup& soup, const Chambers& chambers, Changes& changes) {
  std::vector<FacetRegions> regions;
  const std::vector<char> enclosed = enclosed_voids(chambers);
  std::size_t count = 0, dropped = 0, turned = 0;
  Vec3 dropped_at;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto [ahead, behind] = chambers.beside[t];
    const RegionId region_ahead = chambers.chambers[ahead].region,
                   region_behind = chambers.chambers[behind].region;
    if (region_ahead == no_entity && region_behind == no_entity) {
      if (dropped++ == 0) dropped_at = middle_of(soup, static_cast<std::int32_t>(t));
      continue;
    }
    if (region_ahead == region_behind) {
      throw CadError(fmt::format(
          "{}: the triangles at {} lie within '{}' and divide nothing; delete the sheet there, or "
          "give it thickness",
          soup.file, geometry::place_text(middle_of(soup, static_cast<std::int32_t>(t))),
          chambers.chambers[ahead].name));
    }
    const bool turn =
        region_behind == no_entity || (region_ahead != no_entity && region_ahead < region_behind);
    FacetRegions sides{turn ? region_ahead : region_behind, turn ? region_behind : region_ahead, false};
    sides.cavity = sides.back == no_entity && enclosed[turn ? behind : ahead] != 0;
    auto corners = soup.triangles[t];
    if (turn) std::swap(corners[1], corners[2]);
    turned += turn;
    soup.triangles[count] = corners;
    soup.group_of[count++] = soup.group_of[t];
    regions.push_back(sides);
  }
  soup.triangles.resize(count), soup.group_of.resize(count);
  if (dropped > 0)
    changes.push_back(
        {fmt::format("{} triangles between two empty spaces are left out", dropped), dropped_at});
  if (turned > 0 && turned < count) changes.push_back({fmt::format("{} triangles are turned round", turned)});
  return regions;
}

std::vector<std::string> name_regions(const Chambers& chambers) {
  std::vector<std::string> names;
  for (const Chamber& chamber : chambers.chambers) {
    if (chamber.region < 0) continue;
    names.resize(std::max(names.size(), static_cast<std::size_t>(chamber.region) + 1));
    names[chamber.region] = chamber.name;
  }
  return names;
}

}  // namespace

FacetComplex make_facet_complex(FacetSoup soup, double feature_angle, Changes& changes,
                                CrossingFacets crossing) {
  const auto close = [&] {
    weld_equal_points(soup);
    drop_void_triangles(soup, changes);
    close_facets(soup, changes);
    refuse_open_sides(soup);
  };
  close();
  const bool united = crossing == CrossingFacets::unite && unite_components(soup, changes);
  if (united) close();
  refuse_contacts(soup);
  const Chambers chambers = find_chambers(soup, changes);
  const std::vector<FacetRegions> regions = orient_facets(soup, chambers, changes);
  if (regions.empty())
    throw CadError(fmt::format("{} encloses no volume; export a closed surface", soup.file));
  std::vector<std::int32_t> same(soup.points.size());
  std::iota(same.begin(), same.end(), 0);
  replace_points(soup, same);  // those of triangles left out go
  FacetComplex complex = split_facets(soup, regions, feature_angle);
  complex.regions = name_regions(chambers);
  complex.united = united;
  return complex;
}

}  // namespace aeroloom::cad
