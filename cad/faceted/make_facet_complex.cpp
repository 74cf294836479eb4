#include "cad/faceted/make_facet_complex.hpp"

#include "cad/faceted/chambers.hpp"
#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/facet_solids.hpp"
#include "cad/faceted/features.hpp"
#include "cad/faceted/unite_components.hpp"
#include "cad/model/library_unit.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/long_names.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

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
/// point out of `front`. `owners` stay those of the triangles.
std::vector<FacetRegions> orient_facets(FacetSoup& soup, const Chambers& chambers,
                                        std::vector<FacetOwners>& owners, Changes& changes) {
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
          soup.file, place_in_file(middle_of(soup, static_cast<std::int32_t>(t))),
          chambers.chambers[ahead].name));
    }
    const bool turn =
        region_behind == no_entity || (region_ahead != no_entity && region_ahead < region_behind);
    FacetRegions sides{turn ? region_ahead : region_behind, turn ? region_behind : region_ahead, false};
    sides.cavity = sides.back == no_entity && enclosed[turn ? behind : ahead] != 0;
    auto corners = soup.triangles[t];
    if (turn) std::swap(corners[1], corners[2]);
    turned += turn && sides.back == no_entity;  // which side of two is the front is chosen here
    soup.triangles[count] = corners;
    owners[count] = owners[t];
    soup.group_of[count++] = soup.group_of[t];
    regions.push_back(sides);
  }
  soup.triangles.resize(count), soup.group_of.resize(count), owners.resize(count);
  if (dropped > 0)
    changes.push_back(
        {fmt::format("{} triangles between two empty spaces are left out", dropped), dropped_at});
  if (turned > 0 && turned < count) changes.push_back({fmt::format("{} triangles are turned round", turned)});
  return regions;
}

/// Regions have the names of region points, else those of their solids.
std::vector<std::string> name_regions(const Chambers& chambers, const FacetSolids& solids) {
  std::vector<std::string> names;
  std::vector<std::int32_t> solid_of;
  for (const Chamber& chamber : chambers.chambers) {
    if (chamber.region < 0) continue;
    const std::size_t count = std::max(names.size(), static_cast<std::size_t>(chamber.region) + 1);
    names.resize(count), solid_of.resize(count, -1);
    names[chamber.region] = chamber.name, solid_of[chamber.region] = chamber.solid;
  }
  std::map<std::string, int> uses;
  for (std::size_t r = 0; r < names.size(); ++r) {
    if (!names[r].empty() || solid_of[r] < 0) continue;
    const std::string& name = solids.solids[solid_of[r]].name;
    if (name.empty()) continue;
    const int use = ++uses[name];
    names[r] = use == 1 ? name : fmt::format("{}_{}", name, use);
  }
  return names;
}

/// Faces between regions do not have the name of one of their solids.
void name_interfaces(FacetSoup& soup, const std::vector<FacetRegions>& regions, const FacetSolids& solids) {
  std::vector<std::int32_t> nameless(soup.groups.size(), -1);
  for (std::size_t t = 0; t < regions.size(); ++t) {
    const std::int32_t owner = solids.of[t][0];
    if (regions[t].back == no_entity || !solids.solids[owner].is_group) continue;
    const std::int32_t group = soup.group_of[t];
    if (soup.groups[group].name.empty() || !soup.groups[group].patch.empty()) continue;
    if (nameless[group] < 0) {
      nameless[group] = static_cast<std::int32_t>(soup.groups.size());
      FacetSoup::Group between = soup.groups[group];
      between.part = solids.solids[owner].name, between.name.clear();
      soup.groups.push_back(std::move(between));
    }
    soup.group_of[t] = nameless[group];
  }
}

/// Welds, drops and closes; the solids are those of the file where it is closed.
FacetSolids close_soup(FacetSoup& soup, OpeningRules& openings, Changes& changes) {
  weld_equal_points(soup);
  drop_flat_triangles(soup, changes);
  if (open_sides(soup.triangles).empty()) {
    FacetSolids solids = find_solids(soup);
    merge_repeated_triangles(soup, solids, changes);
    if (open_sides(soup.triangles).empty()) return solids;
  } else {
    drop_void_triangles(soup, changes);
  }
  close_facets(soup, openings, changes);
  refuse_open_sides(soup);
  return find_solids(soup);
}

/// Unites what crosses; what cannot be united is joined if it touches. Whether anything was united.
bool unite_solids(FacetSoup& soup, FacetSolids& solids, bool& imprinted, Changes& changes) {
  FacetSoup united = soup;
  Changes made;
  try {
    if (!unite_components(united, made)) return false;
    OpeningRules none;
    FacetSolids found = close_soup(united, none, made);
    soup = std::move(united), solids = std::move(found);
    changes.insert(changes.end(), made.begin(), made.end());
    return true;
  } catch (const CadError& error) {
    const std::string why = error.what();
    try {
      imprinted = imprint_solids(soup, solids, TouchingSolids::in_faces, changes);
    } catch (const CadError& fault) {
      throw CadError(fmt::format("{}; nor can they be united: {}", fault.what(), why));
    }
    if (!imprinted) throw;
    return false;
  }
}

}  // namespace

FacetComplex make_facet_complex(FacetSoup soup, double feature_angle, Changes& changes,
                                CrossingFacets crossing, const std::vector<std::string>& voids,
                                OpeningRules* openings) {
  if (soup.cut_names > 0) changes.push_back({geometry::long_names_text(soup.cut_names), {}, 0, true});
  if (soup.zeroed > 0) {
    changes.push_back({fmt::format(
        "{} coordinates are so small beside the largest one that they count as zero", soup.zeroed)});
  }
  OpeningRules none;
  FacetSolids solids = close_soup(soup, openings ? *openings : none, changes);
  bool imprinted = false;
  const bool united = crossing == CrossingFacets::unite && unite_solids(soup, solids, imprinted, changes);
  if (!imprinted) imprinted = imprint_solids(soup, solids, TouchingSolids::anyhow, changes);
  const NestingRules rules{
      voids, crossing == CrossingFacets::join ? OverlappingSolids::refuse : OverlappingSolids::fill};
  const Chambers chambers = find_chambers(soup, solids, rules, changes);
  const std::vector<FacetRegions> regions = orient_facets(soup, chambers, solids.of, changes);
  if (regions.empty())
    throw CadError(fmt::format("{} encloses no volume; export a closed surface", soup.file));
  std::vector<std::int32_t> same(soup.points.size());
  std::iota(same.begin(), same.end(), 0);
  replace_points(soup, same);  // those of triangles left out go
  name_interfaces(soup, regions, solids);
  FacetComplex complex = split_facets(soup, regions, feature_angle);
  complex.regions = name_regions(chambers, solids);
  complex.united = united, complex.imprinted = imprinted, complex.nested = chambers.nested;
  return complex;
}

}  // namespace aeroloom::cad
