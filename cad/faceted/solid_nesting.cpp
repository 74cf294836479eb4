#include "cad/faceted/solid_nesting.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/patches.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using Solid = std::int32_t;

/// Triangles of the same solids between the same chambers: one way from one to the other.
struct ChamberDoor {
  std::array<std::int32_t, 2> chambers;  // the lower first
  FacetOwners owners;
  std::int32_t triangle;

  friend bool operator==(const ChamberDoor& a, const ChamberDoor& b) {
    return a.chambers == b.chambers && a.owners == b.owners;
  }
  friend bool operator<(const ChamberDoor& a, const ChamberDoor& b) {
    return std::tie(a.chambers, a.owners, a.triangle) < std::tie(b.chambers, b.owners, b.triangle);
  }
  bool bounds(Solid solid) const { return owners[0] == solid || owners[1] == solid; }
};

class SolidNester {
public:
  SolidNester(const FacetSoup& soup, const FacetSolids& solids, std::size_t chambers)
      : _soup(soup),
        _solids(solids),
        _around(chambers),
        _inside(solids.solids.size(), 0),
        _asked(solids.solids.size(), 0) {}

  SolidNesting run(const std::vector<std::array<std::int32_t, 2>>& beside, const NestingRules& rules,
                   Changes& changes) {
    ask_for_voids(rules.voids);
    find_doors(beside);
    find_solids_around();
    for (const std::vector<Solid>& around : _around) {
      for (const Solid solid : around) ++_inside[solid];
    }
    if (rules.overlapping == OverlappingSolids::refuse) refuse_overlaps();
    fill();
    describe(changes);
    return std::move(_result);
  }

private:
  void ask_for_voids(const std::vector<std::string>& voids) {
    for (const std::string& pattern : voids) {
      bool any = false;
      for (Solid s = 0; s < static_cast<Solid>(_asked.size()); ++s) {
        if (!matches_pattern(solid_name(_solids, s), pattern)) continue;
        _asked[s] = 1;
        any = true;
      }
      if (any) continue;
      std::string names;
      constexpr Solid most = 10;
      for (Solid s = 0; s < std::min(most, static_cast<Solid>(_asked.size())); ++s)
        names += (s == 0 ? "" : ", ") + solid_text(_solids, s);
      throw CadError(fmt::format("{}: DomainOptions::voids: no solid has a name like '{}'; there are {}",
                                 _soup.file, pattern, names));
    }
  }

  void find_doors(const std::vector<std::array<std::int32_t, 2>>& beside) {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(beside.size()); ++t) {
      const auto [a, b] = beside[t];
      _doors.push_back({{std::min(a, b), std::max(a, b)}, _solids.of[t], t});
    }
    geometry::sort_unique(_doors);
    _from.resize(_around.size());
    for (std::size_t d = 0; d < _doors.size(); ++d) {
      for (const std::int32_t c : _doors[d].chambers) _from[c].push_back(static_cast<std::int32_t>(d));
    }
  }

  /// Through each triangle of a solid, from outside. Solids for which ways differ, as those with a wall
  /// inside, enclose what no way leads to but through their triangles.
  void find_solids_around() {
    std::vector<char> seen(_around.size(), 0);
    std::vector<std::int32_t> reached{0};
    seen[0] = 1;
    std::vector<Solid> unclear;
    while (!reached.empty()) {
      const std::int32_t at = reached.back();
      reached.pop_back();
      for (const std::int32_t d : _from[at]) {
        const ChamberDoor& door = _doors[d];
        const std::int32_t next = door.chambers[door.chambers[0] == at ? 1 : 0];
        std::vector<Solid> beyond = _around[at], owners;
        for (const Solid solid : door.owners)
          if (solid >= 0) owners.push_back(solid);
        std::sort(owners.begin(), owners.end());
        beyond = difference(beyond, owners);
        if (seen[next] == 0) {
          seen[next] = 1;
          _around[next] = std::move(beyond);
          reached.push_back(next);
        } else {
          const std::vector<Solid> differ = difference(beyond, _around[next]);
          unclear.insert(unclear.end(), differ.begin(), differ.end());
        }
      }
    }
    geometry::sort_unique(unclear);
    for (const Solid solid : unclear) enclose_unreached(solid);
  }

  static std::vector<Solid> difference(const std::vector<Solid>& a, const std::vector<Solid>& b) {
    std::vector<Solid> result;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
  }

  void enclose_unreached(Solid solid) {
    std::vector<char> reachable(_around.size(), 0);
    std::vector<std::int32_t> reached{0};
    reachable[0] = 1;
    while (!reached.empty()) {
      const std::int32_t at = reached.back();
      reached.pop_back();
      for (const std::int32_t d : _from[at]) {
        if (_doors[d].bounds(solid)) continue;
        for (const std::int32_t next : _doors[d].chambers) {
          if (reachable[next] == 0) reached.push_back(next);
          reachable[next] = 1;
        }
      }
    }
    for (std::size_t c = 0; c < _around.size(); ++c) {
      std::erase(_around[c], solid);
      if (reachable[c] == 0) _around[c].push_back(solid);
      std::sort(_around[c].begin(), _around[c].end());
    }
  }

  void refuse_overlaps() const {
    std::map<std::pair<Solid, Solid>, std::pair<std::int32_t, std::int32_t>> common;  // chambers, one of them
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(_around.size()); ++c) {
      const std::vector<Solid>& around = _around[c];
      for (std::size_t i = 0; i < around.size(); ++i) {
        for (std::size_t j = i + 1; j < around.size(); ++j) {
          auto& [count, chamber] = common[{around[i], around[j]}];
          ++count, chamber = c;
        }
      }
    }
    for (const auto& [pair, shared] : common) {
      if (shared.first == std::min(_inside[pair.first], _inside[pair.second])) continue;
      const std::int32_t at = _doors[_from[shared.second].front()].triangle;
      throw CadError(fmt::format(
          "{}: {} and {} overlap at {}. Remedy: unite them, or make them touch, in the program that "
          "made the file; or take them as bodies (DomainOptions::kind: body)",
          _soup.file, solid_text(_solids, pair.first), solid_text(_solids, pair.second),
          place_in_file(middle_of(_soup, at))));
    }
  }

  /// From outside inwards. Of solids that enclose the same, one that is turned inward comes first: the other
  /// one fills its void.
  std::vector<Solid> chain_of(std::int32_t chamber) const {
    std::vector<Solid> chain = _around[chamber];
    std::ranges::sort(chain, {}, [&](Solid s) {
      return std::tuple(-_inside[s], _solids.solids[s].turn != SolidTurn::inward, s);
    });
    return chain;
  }

  /// The solid that fills what is within the first `count` of a chain; -1: none does.
  Solid filler_of(const std::vector<Solid>& chain, std::size_t count) const {
    Solid filler = -1, parent = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const bool fills = _asked[chain[i]] == 0 && (filler < 0 || turned_alike(chain[i], parent));
      filler = fills ? chain[i] : -1;
      if (fills) parent = chain[i];
    }
    return filler;
  }

  bool turned_alike(Solid inner, Solid outer) const {
    const SolidTurn a = _solids.solids[inner].turn, b = _solids.solids[outer].turn;
    return a == b && a != SolidTurn::both;
  }

  void fill() {
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(_around.size()); ++c) {
      const std::vector<Solid> chain = chain_of(c);
      _result.filler.push_back(filler_of(chain, chain.size()));
      _result.filled.push_back(_result.filler.back() >= 0 ? 1 : 0);
    }
  }

  void describe(Changes& changes) {
    std::vector<char> seen(_inside.size(), 0);
    std::size_t shown = 0, regions = 0, spaces = 0;
    constexpr std::size_t most_shown = 8;
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(_around.size()); ++c) {
      const std::vector<Solid> chain = chain_of(c);
      for (std::size_t i = 1; i < chain.size(); ++i) {
        const Solid inner = chain[i], outer = chain[i - 1];
        if (std::exchange(seen[inner], 1) != 0) continue;
        const bool fills = filler_of(chain, i + 1) == inner;
        if (fills && is_copy(inner, outer)) continue;
        _result.nested += fills;
        if (++shown <= most_shown) {
          changes.push_back({fmt::format("solid {} lies in {}: {}", solid_text(_solids, inner),
                                         solid_text(_solids, outer), reason(inner, fills)),
                             middle_of(_soup, door_of(inner).triangle)});
        } else {
          ++(fills ? regions : spaces);
        }
      }
    }
    if (regions + spaces > 0) {
      changes.push_back({fmt::format("{} more solids lie in others: {} are regions, {} are voids",
                                     regions + spaces, regions, spaces)});
    }
  }

  /// Of solids one of which lies within the other.
  bool is_copy(Solid inner, Solid outer) const {
    return _inside[inner] == _inside[outer] && turned_alike(inner, outer);
  }

  std::string reason(Solid inner, bool fills) const {
    if (fills) return "a region of its own (DomainOptions::voids makes it a void)";
    if (_asked[inner] != 0) return "a void, as asked for";
    return _solids.solids[inner].turn == SolidTurn::both ? "a void, since its triangles are turned both ways"
                                                         : "a void, since it is turned the other way";
  }

  const ChamberDoor& door_of(Solid solid) const {
    return *std::ranges::find_if(_doors, [&](const ChamberDoor& door) { return door.bounds(solid); });
  }

  const FacetSoup& _soup;
  const FacetSolids& _solids;
  std::vector<ChamberDoor> _doors;
  std::vector<std::vector<std::int32_t>> _from;  // doors of each chamber
  std::vector<std::vector<Solid>> _around;       // solids around each chamber, ascending
  std::vector<std::int32_t> _inside;             // chambers in each solid
  std::vector<char> _asked;                      // to be a void
  SolidNesting _result;
};

}  // namespace

SolidNesting nest_solids(const FacetSoup& soup, const FacetSolids& solids,
                         const std::vector<std::array<std::int32_t, 2>>& beside, std::size_t chambers,
                         const NestingRules& rules, Changes& changes) {
  return SolidNester(soup, solids, chambers).run(beside, rules, changes);
}

}  // namespace aeroloom::cad
