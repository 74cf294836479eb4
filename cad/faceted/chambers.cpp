#include "cad/faceted/chambers.hpp"

#include "cad/faceted/facet_rays.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/model/model.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::orient3d;

/// Triangle t has the leaf 2 t on the side that its normal points to, and 2 t + 1 behind.
using Leaf = std::int32_t;

/// A closed surface of leaves that bounds one chamber.
struct ChamberShell {
  double volume6 = 0;  ///< of what lies on the leaves' side: negative where that has no end
  Leaf best = -1;      ///< of the roundest triangle
  double best_width = -1;
  std::int32_t chamber = -1;
};

class ChamberFinder {
public:
  ChamberFinder(const FacetSoup& soup, Changes& changes)
      : _soup(soup), _changes(changes), _rays(soup), _leaves(2 * soup.triangles.size()) {}

  Chambers find(const FacetSolids& solids, const NestingRules& rules) {
    pair_leaves();
    number_shells();
    measure_shells();
    place_shells();
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      const auto chamber = [&](std::size_t leaf) { return _shells[_shell_of[leaf]].chamber; };
      _result.beside.push_back({chamber(2 * t), chamber(2 * t + 1)});
    }
    mark_filled(solids, rules);
    number_regions();
    return std::move(_result);
  }

private:
  Vec3 point(std::int32_t p) const { return _soup.points[p]; }

  /// A triangle at a side, and whether it runs along the side from low to high.
  struct Blade {
    std::int32_t apex, triangle;
    bool forward;
    Leaf ahead() const { return 2 * triangle + (forward ? 0 : 1); }   // faces growing angles
    Leaf behind() const { return 2 * triangle + (forward ? 1 : 0); }  // faces falling angles
  };

  void pair_leaves() {
    std::vector<Blade> blades;
    for_each_side(sort_sides(_soup.triangles), [&](std::span<const FacetSide> passes) {
      blades.clear();
      for (const FacetSide& pass : passes) {
        const std::int32_t t = facet_of(pass.half_edge);
        blades.push_back({side_apex(_soup.triangles, pass.half_edge), t,
                          side_begin(_soup.triangles, pass.half_edge) == pass.low});
      }
      if (blades.size() > 2) sort_blades(point(passes.front().low), point(passes.front().high), blades);
      for (std::size_t i = 0; i < blades.size(); ++i)
        _leaves.unite(blades[i].ahead(), blades[(i + 1) % blades.size()].behind());
    });
  }

  /// By the angle from the first blade, counter-clockwise about the side from low to high.
  void sort_blades(Vec3 low, Vec3 high, std::vector<Blade>& blades) const {
    const Vec3 first = point(blades.front().apex);
    const auto half = [&](const Blade& b) { return orient3d(low, high, first, point(b.apex)) > 0 ? 0 : 1; };
    std::sort(blades.begin() + 1, blades.end(), [&](const Blade& a, const Blade& b) {
      const int half_a = half(a), half_b = half(b);
      if (half_a != half_b) return half_a < half_b;
      return orient3d(low, high, point(a.apex), point(b.apex)) > 0;
    });
  }

  void number_shells() {
    std::vector<std::int32_t> number(_leaves.size(), -1);
    std::int32_t count = 0;
    for (Leaf leaf = 0; leaf < static_cast<Leaf>(_leaves.size()); ++leaf) {
      std::int32_t& own = number[_leaves.root(leaf)];
      if (own < 0) own = count++;
      _shell_of.push_back(own);
    }
    _shells.resize(count);
  }

  void measure_shells() {
    for (Leaf leaf = 0; leaf < static_cast<Leaf>(_shell_of.size()); ++leaf) {
      const std::int32_t t = leaf / 2;
      const auto& [a, b, c] = _soup.triangles[t];
      ChamberShell& shell = _shells[_shell_of[leaf]];
      const double around =
          distance(point(a), point(b)) + distance(point(b), point(c)) + distance(point(c), point(a));
      const double width = norm(cross(point(b) - point(a), point(c) - point(a))) / around;
      if (width > shell.best_width) shell.best = leaf, shell.best_width = width;
    }
    for (Leaf leaf = 0; leaf < static_cast<Leaf>(_shell_of.size()); ++leaf) {
      const auto& [a, b, c] = _soup.triangles[leaf / 2];
      ChamberShell& shell = _shells[_shell_of[leaf]];
      const double volume =
          geometry::volume6(point(_soup.triangles[shell.best / 2][0]), point(a), point(b), point(c));
      shell.volume6 += leaf % 2 == 0 ? -volume : volume;
    }
  }

  Vec3 way_of_leaf(Leaf leaf) const {
    const Vec3 normal = area_vector2(corners_of(_soup, leaf / 2));
    return leaf % 2 == 0 ? normal : -normal;
  }

  /// The chamber that a point lies in: of the shells passed an odd number of times, the smallest.
  std::int32_t chamber_around(Vec3 at, Leaf from) const {
    const std::vector<std::int32_t> passed =
        _rays.passed(at, from < 0 ? -1 : from / 2, from < 0 ? Vec3{0.3, 0.5, 0.8} : way_of_leaf(from));
    std::vector<std::int32_t> shells;
    for (const std::int32_t t : passed) {
      if (_shell_of[2 * t] == _shell_of[2 * t + 1]) continue;
      shells.push_back(_shell_of[2 * t]), shells.push_back(_shell_of[2 * t + 1]);
    }
    std::sort(shells.begin(), shells.end());
    std::int32_t smallest = -1;
    geometry::for_each_run(std::span<const std::int32_t>(shells), std::equal_to<>(),
                           [&](std::size_t first, std::size_t last) {
                             const std::int32_t shell = shells[first];
                             if ((last - first) % 2 == 0 || _shells[shell].volume6 <= 0) return;
                             if (smallest < 0 || _shells[shell].volume6 < _shells[smallest].volume6)
                               smallest = shell;
                           });
    return smallest < 0 ? 0 : _shells[smallest].chamber;
  }

  void place_shells() {
    _result.chambers.emplace_back();
    for (ChamberShell& shell : _shells) {
      if (shell.volume6 <= 0) continue;
      shell.chamber = static_cast<std::int32_t>(_result.chambers.size());
      _result.chambers.emplace_back();
    }
    // A single body needs no look at what is around it.
    const bool single = _shells.size() == 2;
    for (ChamberShell& shell : _shells) {
      if (shell.volume6 > 0) continue;
      shell.chamber = single ? 0 : chamber_around(middle_of(_soup, shell.best / 2), shell.best);
    }
  }

  void mark_filled(const FacetSolids& solids, const NestingRules& rules) {
    std::vector<Chamber>& chambers = _result.chambers;
    if (_soup.filling == Filling::all) {
      for (std::size_t c = 1; c < chambers.size(); ++c) chambers[c].filled = true;
    } else {
      const SolidNesting nesting =
          nest_solids(_soup, solids, _result.beside, chambers.size(), rules, _changes);
      for (std::size_t c = 0; c < chambers.size(); ++c)
        chambers[c].filled = nesting.filled[c] != 0, chambers[c].solid = nesting.filler[c];
      _result.nested = nesting.nested;
    }
    for (const Vec3 hole : _soup.holes) {
      const std::int32_t c = chamber_around(hole, -1);
      if (c == 0) _changes.push_back({"a hole point outside all facets has no effect", hole});
      chambers[c].filled = false;
    }
    for (const FacetSoup::RegionPoint& region : _soup.regions) {
      const std::int32_t c = chamber_around(region.point, -1);
      if (c == 0 || !chambers[c].filled) {
        _changes.push_back({fmt::format("the point of '{}' lies in no region and has no effect", region.name),
                            region.point});
      } else {
        chambers[c].name = region.name;
      }
    }
  }

  void number_regions() {
    std::int32_t count = 0;
    for (const std::int32_t shell : _shell_of) {
      Chamber& chamber = _result.chambers[_shells[shell].chamber];
      if (chamber.filled && chamber.region < 0) chamber.region = count++;
    }
  }

  const FacetSoup& _soup;
  Changes& _changes;
  FacetRays _rays;
  geometry::DisjointSets<Leaf> _leaves;
  std::vector<std::int32_t> _shell_of;  // of each leaf
  std::vector<ChamberShell> _shells;
  Chambers _result;
};

}  // namespace

Chambers find_chambers(const FacetSoup& soup, const FacetSolids& solids, const NestingRules& rules,
                       Changes& changes) {
  return ChamberFinder(soup, changes).find(solids, rules);
}

}  // namespace aeroloom::cad
