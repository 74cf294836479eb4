#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/facet_solids.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "geometry/imprint_triangles.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Whose triangles a pair is, and where.
[[noreturn]] void refuse_pair(const FacetSoup& soup, const FacetSolids& solids, const FacetContact& pair,
                              std::size_t pairs, const std::string& why) {
  const std::int32_t first = solids.of[pair.first][0], second = solids.of[pair.second][0];
  const std::string place = place_in_file(middle_of(soup, pair.first));
  if (first == second) {
    throw CadError(
        fmt::format("{}: the surface of {} crosses or touches itself at {}, in {} pairs of triangles; "
                    "repair it there and export it again",
                    soup.file, solid_text(solids, first), place, pairs));
  }
  throw CadError(
      fmt::format("{}: {} and {} {} at {} ({} pairs of triangles in all). Remedy: make their common "
                  "faces equal or move them apart in the CAD program; or unite them there",
                  soup.file, solid_text(solids, first), solid_text(solids, second), why, place, pairs));
}

/// The pair of two different solids, if there is one, else the first.
FacetContact shown_pair(const std::vector<FacetContact>& contacts, const FacetSolids& solids) {
  const auto apart = std::ranges::find_if(contacts, [&](const FacetContact& pair) {
    return solids.of[pair.first][0] != solids.of[pair.second][0];
  });
  return apart == contacts.end() ? contacts.front() : *apart;
}

constexpr const char* no_fit =
    "touch, but their triangles cannot be cut along each other, because they are not exactly in one plane";

void require_fit(const FacetSoup& soup, const FacetSolids& solids, const FacetContact& before,
                 const FacetSoup& soup_before, const FacetSolids& solids_before, std::size_t pairs) {
  const std::vector<FacetContact> left = list_facet_contacts(soup);
  if (!left.empty()) refuse_pair(soup, solids, shown_pair(left, solids), left.size(), no_fit);
  if (!open_sides(soup.triangles).empty()) refuse_pair(soup_before, solids_before, before, pairs, no_fit);
}

/// A pair of triangles whose solids share no triangle, after `merged` triangles were found to be others.
const FacetContact* without_common_face(const std::vector<FacetContact>& contacts, const FacetSolids& before,
                                        const FacetSolids& after, std::size_t merged) {
  std::set<FacetOwners> sharing;
  for (const FacetOwners& owners : after.of) {
    if (owners[1] >= 0) sharing.insert({std::min(owners[0], owners[1]), std::max(owners[0], owners[1])});
  }
  for (const FacetContact& pair : contacts) {
    const auto [first, second] = std::minmax(before.of[pair.first][0], before.of[pair.second][0]);
    if (first == second ? merged == 0 : sharing.count({first, second}) == 0) return &pair;
  }
  return nullptr;
}

}  // namespace

bool imprint_solids(FacetSoup& soup, FacetSolids& solids, TouchingSolids touching, Changes& changes) {
  std::vector<FacetContact> contacts = list_facet_contacts(soup);
  if (contacts.empty()) return false;
  // Pairs of two solids tell more in messages.
  std::ranges::stable_partition(contacts, [&](const FacetContact& pair) {
    return solids.of[pair.first][0] != solids.of[pair.second][0];
  });
  const FacetContact shown = shown_pair(contacts, solids);
  std::vector<std::array<std::int32_t, 2>> pairs;
  std::set<std::int32_t> all;
  for (const FacetContact& pair : contacts) {
    pairs.push_back({pair.first, pair.second});
    all.insert(solids.of[pair.first][0]), all.insert(solids.of[pair.second][0]);
  }
  const geometry::ImprintedTriangles found = geometry::imprint_triangles(soup.points, soup.triangles, pairs);
  if (found.crossing)
    refuse_pair(soup, solids, {(*found.crossing)[0], (*found.crossing)[1]}, contacts.size(), "overlap");
  FacetSoup cut = soup;
  FacetSolids owners{solids.solids, {}};
  cut.points = found.points, cut.triangles = found.triangles;
  cut.group_of.clear();
  for (const std::int32_t source : found.sources) {
    cut.group_of.push_back(soup.group_of[source]);
    owners.of.push_back(solids.of[source]);
  }
  weld_equal_points(cut);
  const std::size_t before = cut.triangles.size();
  Changes made;
  merge_repeated_triangles(cut, owners, made);
  require_fit(cut, owners, shown, soup, solids, contacts.size());
  if (touching == TouchingSolids::in_faces) {
    const FacetContact* const bare =
        without_common_face(contacts, solids, owners, before - cut.triangles.size());
    if (bare != nullptr)
      refuse_pair(soup, solids, *bare, contacts.size(), "touch along a line or at a point");
  }
  changes.push_back({fmt::format("{} triangles of {} are cut along each other where they touch", found.cut,
                                 all.size() == 1 ? "a surface" : fmt::format("{} solids", all.size())),
                     middle_of(soup, shown.first)});
  soup = std::move(cut), solids = std::move(owners);
  return true;
}

}  // namespace aeroloom::cad
