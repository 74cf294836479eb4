#include "cad/faceted/unite_components.hpp"

#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_solids.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/tolerances.hpp"
#include "geometry/unite_surfaces.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::ClosedSurface;
using ComponentPair = std::pair<std::int32_t, std::int32_t>;

/// Of components that meet, the lower first, the first contact.
using Meetings = std::map<ComponentPair, FacetContact>;

Meetings meetings_of(const std::vector<FacetContact>& contacts, const FacetComponents& components) {
  Meetings meetings;
  for (const FacetContact& contact : contacts)
    meetings.try_emplace(std::minmax(components.of[contact.first], components.of[contact.second]), contact);
  return meetings;
}

/// Components that hang together over meetings, each but the first met by one before it.
std::vector<std::vector<std::int32_t>> groups_of(const Meetings& meetings, std::int32_t count) {
  std::vector<std::vector<std::int32_t>> beside(count), groups;
  for (const auto& [pair, contact] : meetings) {
    beside[pair.first].push_back(pair.second);
    beside[pair.second].push_back(pair.first);
  }
  std::vector<char> seen(count, 0);
  for (std::int32_t c = 0; c < count; ++c) {
    if (seen[c] != 0 || beside[c].empty()) continue;
    std::vector<std::int32_t>& group = groups.emplace_back(1, c);
    seen[c] = 1;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const std::int32_t next : beside[group[i]]) {
        if (seen[next] == 0) group.push_back(next);
        seen[next] = 1;
      }
    }
  }
  return groups;
}

double enclosed_by(const ClosedSurface& surface) {
  const Vec3 from = surface.points.front();
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += dot(surface.points[a] - from, cross(surface.points[b] - from, surface.points[c] - from)) / 6;
  return volume;
}

/// A component on its own, normals outwards.
ClosedSurface component_surface(const FacetSoup& soup, const std::vector<std::int32_t>& triangles) {
  ClosedSurface surface;
  std::map<std::int32_t, std::int32_t> number;
  for (const std::int32_t t : triangles) {
    geometry::TriangleCorners corners{};
    for (int i = 0; i < 3; ++i) {
      const std::int32_t p = soup.triangles[t][i];
      const auto [at, is_new] = number.try_emplace(p, static_cast<std::int32_t>(surface.points.size()));
      if (is_new) surface.points.push_back(soup.points[p]);
      corners[i] = at->second;
    }
    surface.triangles.push_back(corners);
  }
  if (enclosed_by(surface) < 0) {
    for (auto& corners : surface.triangles) std::swap(corners[1], corners[2]);
  }
  return surface;
}

class ComponentUnion {
public:
  ComponentUnion(FacetSoup& soup, const FacetComponents& components, Meetings meetings)
      : _soup(soup), _components(components), _meetings(std::move(meetings)), _members(components.count) {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(soup.triangles.size()); ++t)
      _members[components.of[t]].push_back(t);
  }

  void run(Changes& changes) {
    const std::vector<std::vector<std::int32_t>> all = groups_of(_meetings, _components.count);
    std::vector<char> united(_components.count, 0);
    for (const auto& group : all) {
      for (const std::int32_t component : group) united[component] = 1;
    }
    std::vector<geometry::TriangleCorners> triangles;
    std::vector<std::int32_t> groups;
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      if (united[_components.of[t]] != 0) continue;
      triangles.push_back(_soup.triangles[t]);
      groups.push_back(_soup.group_of[t]);
    }
    for (const std::vector<std::int32_t>& group : all) {
      const geometry::UnitedSurface whole = unite(group);
      const auto base = static_cast<std::int32_t>(_soup.points.size());
      _soup.points.insert(_soup.points.end(), whole.surface.points.begin(), whole.surface.points.end());
      for (std::size_t t = 0; t < whole.sources.size(); ++t) {
        const auto& [a, b, c] = whole.surface.triangles[t];
        triangles.push_back({base + a, base + b, base + c});
        const geometry::TriangleSource source = whole.sources[t];
        groups.push_back(_soup.group_of[_members[group[source.surface]][source.triangle]]);
      }
      changes.push_back(describe(group));
    }
    _soup.triangles = std::move(triangles), _soup.group_of = std::move(groups);
  }

private:
  std::string name(std::int32_t component) const {
    return component_name(_soup, _components, _members[component].front());
  }

  const FacetContact* contact(std::int32_t a, std::int32_t b) const {
    const auto found = _meetings.find(std::minmax(a, b));
    return found == _meetings.end() ? nullptr : &found->second;
  }

  geometry::UnitedSurface unite(const std::vector<std::int32_t>& group) const {
    std::vector<ClosedSurface> surfaces;
    surfaces.reserve(group.size());
    for (const std::int32_t component : group)
      surfaces.push_back(component_surface(_soup, _members[component]));
    report_step(fmt::format("uniting {} and {} others", name(group.front()), group.size() - 1));
    try {
      return geometry::unite_surfaces(surfaces, tolerances::exact_volume);
    } catch (const geometry::UnionError& error) {
      refuse(group, error);
    }
  }

  [[noreturn]] void refuse(const std::vector<std::int32_t>& group, const geometry::UnionError& error) const {
    const std::int32_t last = group[std::max<std::size_t>(error.surface(), 1)];
    for (const std::int32_t other : group) {
      const FacetContact* const found = other == last ? nullptr : contact(other, last);
      if (found == nullptr) continue;
      throw CadError(fmt::format(
          "{}: {} and {} overlap or touch at {}, and their union is no sound body: {}. Remedy: unite them in "
          "the CAD program, or move one so that they overlap clearly or stay apart",
          _soup.file, name(other), name(last), place_in_file(middle_of(_soup, found->first)), error.what()));
    }
    throw CadError(fmt::format("{}: {}: {}", _soup.file, name(last), error.what()));
  }

  Change describe(const std::vector<std::int32_t>& group) const {
    constexpr std::size_t most_named = 4;
    std::string names;
    for (std::size_t i = 0; i < std::min(group.size(), most_named); ++i)
      names += (i > 0 ? ", " : "") + name(group[i]);
    if (group.size() > most_named) names += fmt::format(" and {} more", group.size() - most_named);
    return {fmt::format("bodies of triangles that overlap are united: {}", names),
            middle_of(_soup, contact(group[0], group[1])->first)};
  }

  FacetSoup& _soup;
  const FacetComponents& _components;
  Meetings _meetings;
  std::vector<std::vector<std::int32_t>> _members;  // triangles of each component
};

}  // namespace

bool unite_components(FacetSoup& soup, Changes& changes) {
  if (soup.filling != Filling::alternating) return false;
  const FacetComponents components = find_components(soup);
  Meetings meetings = meetings_of(list_facet_contacts(soup), components);
  const auto is_own = [](const auto& meeting) { return meeting.first.first == meeting.first.second; };
  if (std::all_of(meetings.begin(), meetings.end(), is_own)) return false;
  const auto own = std::find_if(meetings.begin(), meetings.end(), is_own);
  if (own != meetings.end()) {
    const std::int32_t at = own->second.first;
    throw CadError(
        fmt::format("{}: {} crosses or touches itself at {} and cannot be united with what it overlaps. "
                    "Remedy: repair it there and export it again",
                    soup.file, component_name(soup, components, at), place_in_file(middle_of(soup, at))));
  }
  turn_alike(soup);
  ComponentUnion(soup, components, std::move(meetings)).run(changes);
  return true;
}

}  // namespace aeroloom::cad
