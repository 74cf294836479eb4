#include "cad/faceted/facet_solids.hpp"

#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Numbers of groups, or of parts, or one for all.
enum class SolidKey : std::uint8_t { group, part, none };

std::vector<std::int32_t> keys_of(const FacetSoup& soup, SolidKey key) {
  std::vector<std::int32_t> of_group(soup.groups.size(), 0);
  std::map<std::string, std::int32_t> number;
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    if (key == SolidKey::group) of_group[g] = static_cast<std::int32_t>(g);
    if (key == SolidKey::part) {
      of_group[g] =
          number.try_emplace(soup.groups[g].part, static_cast<std::int32_t>(number.size())).first->second;
    }
  }
  std::vector<std::int32_t> keys;
  keys.reserve(soup.triangles.size());
  for (const std::int32_t g : soup.group_of) keys.push_back(of_group[g]);
  return keys;
}

/// Whether every side has an even number of triangles of each key.
bool closed_by_key(const std::vector<FacetSide>& sides, const std::vector<std::int32_t>& keys) {
  bool closed = true;
  std::map<std::int32_t, int> count;
  for_each_side(sides, [&](std::span<const FacetSide> passes) {
    if (passes.size() == 2) {
      closed = closed && keys[facet_of(passes[0].half_edge)] == keys[facet_of(passes[1].half_edge)];
      return;
    }
    count.clear();
    for (const FacetSide& pass : passes) ++count[keys[facet_of(pass.half_edge)]];
    for (const auto& [key, uses] : count) closed = closed && uses % 2 == 0;
  });
  return closed;
}

/// Six times the volume of each solid's triangles as they are turned, seen from its first point.
std::vector<double> turned_volumes(const FacetSoup& soup, const FacetSolids& solids) {
  std::vector<double> volumes(solids.solids.size(), 0);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const std::int32_t solid = solids.of[t][0];
    const Vec3 from = soup.points[soup.triangles[solids.solids[solid].triangle][0]];
    const auto [a, b, c] = corners_of(soup, t);
    volumes[solid] += dot(a - from, cross(b - from, c - from));
  }
  return volumes;
}

void find_turns(const FacetSoup& soup, FacetSolids& solids) {
  const std::vector<double> found = turned_volumes(soup, solids);
  FacetSoup alike = soup;
  turn_alike(alike);
  const std::vector<double> whole = turned_volumes(alike, solids);
  constexpr double clear = 0.5;  // chosen: a few triangles that are turned wrongly do not matter
  for (std::size_t s = 0; s < found.size(); ++s) {
    if (std::abs(found[s]) < clear * std::abs(whole[s])) continue;
    solids.solids[s].turn = found[s] < 0 ? SolidTurn::inward : SolidTurn::outward;
  }
}

void find_names(const FacetSoup& soup, FacetSolids& solids) {
  std::vector<std::set<std::int32_t>> groups_of(solids.solids.size()), solids_of(soup.groups.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    groups_of[solids.of[t][0]].insert(soup.group_of[t]);
    solids_of[soup.group_of[t]].insert(solids.of[t][0]);
  }
  for (std::size_t s = 0; s < groups_of.size(); ++s) {
    FacetSolid& solid = solids.solids[s];
    const FacetSoup::Group& first = soup.groups[*groups_of[s].begin()];
    if (groups_of[s].size() == 1) {
      solid.name = first.part.empty() ? first.name : first.part;
      solid.is_group = solids_of[*groups_of[s].begin()].size() == 1;
    } else if (std::ranges::all_of(groups_of[s],
                                   [&](std::int32_t g) { return soup.groups[g].part == first.part; })) {
      solid.name = first.part;
    }
  }
}

}  // namespace

void turn_alike(FacetSoup& soup) {
  const auto count = static_cast<std::int32_t>(soup.triangles.size());
  std::vector<geometry::HalfEdge> twin(3 * soup.triangles.size(), -1);
  for_each_side(sort_sides(soup.triangles), [&](std::span<const FacetSide> passes) {
    if (passes.size() != 2) return;
    twin[passes[0].half_edge] = passes[1].half_edge, twin[passes[1].half_edge] = passes[0].half_edge;
  });
  std::vector<char> turned(soup.triangles.size(), 0), seen(soup.triangles.size(), 0);
  for (std::int32_t seed = 0; seed < count; ++seed) {
    if (seen[seed] != 0) continue;
    std::vector<std::int32_t> waiting{seed};
    seen[seed] = 1;
    while (!waiting.empty()) {
      const std::int32_t t = waiting.back();
      waiting.pop_back();
      for (geometry::HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const std::int32_t other = twin[h] < 0 ? -1 : facet_of(twin[h]);
        if (other < 0 || seen[other] != 0) continue;
        const bool against = side_begin(soup.triangles, h) == side_begin(soup.triangles, twin[h]);
        turned[other] = static_cast<char>((turned[t] != 0) != against);
        seen[other] = 1;
        waiting.push_back(other);
      }
    }
  }
  for (std::int32_t t = 0; t < count; ++t) {
    if (turned[t] != 0) std::swap(soup.triangles[t][1], soup.triangles[t][2]);
  }
}

FacetSolids find_solids(const FacetSoup& soup) {
  const std::vector<FacetSide> sides = sort_sides(soup.triangles);
  std::vector<std::int32_t> keys;
  for (const SolidKey key : {SolidKey::group, SolidKey::part, SolidKey::none}) {
    keys = keys_of(soup, key);
    if (closed_by_key(sides, keys)) break;
  }
  geometry::DisjointSets<std::int32_t> sets(soup.triangles.size());
  for_each_side(sides, [&](std::span<const FacetSide> passes) {
    for (std::size_t i = 0; i < passes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::int32_t a = facet_of(passes[i].half_edge), b = facet_of(passes[j].half_edge);
        if (keys[a] != keys[b]) continue;
        sets.unite(a, b);
        break;
      }
    }
  });
  FacetSolids solids;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(sets.size()); ++t) {
    const std::int32_t root = sets.root(t);
    if (root == t) {
      solids.of.push_back({static_cast<std::int32_t>(solids.solids.size()), -1});
      solids.solids.emplace_back().triangle = t;
    } else {
      solids.of.push_back(solids.of[root]);
    }
  }
  if (solids.solids.size() > 1) find_turns(soup, solids);
  find_names(soup, solids);
  return solids;
}

std::string solid_name(const FacetSolids& solids, std::int32_t solid) {
  const std::string& name = solids.solids[solid].name;
  return name.empty() ? fmt::format("solid_{}", solid) : name;
}

std::string solid_text(const FacetSolids& solids, std::int32_t solid) {
  return fmt::format("'{}'", solid_name(solids, solid));
}

void merge_repeated_triangles(FacetSoup& soup, FacetSolids& solids, Changes& changes) {
  std::vector<std::pair<geometry::TriangleCorners, std::int32_t>> sorted;
  sorted.reserve(soup.triangles.size());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup.triangles.size()); ++t) {
    geometry::TriangleCorners corners = soup.triangles[t];
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::size_t shared = 0;
  for (std::size_t i = 1, first = 0; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[first].first) {
      first = i;
      continue;
    }
    FacetOwners& owners = solids.of[sorted[first].second];
    const std::int32_t other = solids.of[sorted[i].second][0];
    if (other == owners[0] || other == owners[1] || owners[1] >= 0) continue;
    owners[1] = other;
    ++shared;
  }
  std::vector<FacetOwners> kept;
  Changes made;
  FacetSoup numbered = soup;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup.triangles.size()); ++t)
    numbered.group_of[t] = t;
  drop_void_triangles(numbered, made);
  for (std::int32_t& from : numbered.group_of) {
    kept.push_back(solids.of[from]);
    from = soup.group_of[from];
  }
  soup = std::move(numbered);
  solids.of = std::move(kept);
  changes.insert(changes.end(), made.begin(), made.end());
  if (shared > 0) changes.push_back({fmt::format("{} triangles bound two solids that touch", shared)});
}

}  // namespace aeroloom::cad
