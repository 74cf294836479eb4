#include "surface/division/repair_parts.hpp"

#include "geometry/sort_unique.hpp"
#include "surface/division/wedges.hpp"

#include <algorithm>
#include <map>

namespace aeroloom::partition {
namespace {

/// Joining parts may narrow wedges and widening them tear parts: few rounds mend most. Chosen, not
/// measured.
constexpr int repair_rounds = 6;
/// The sum of what is missing around a wedge must fall by more than rounding, or moves would go back and
/// forth.
constexpr double real_fall = 1 - 1e-9;

class Widener {
public:
  Widener(const BackgroundSurface& surface, const VertexFans& fans, double smallest_angle,
          std::vector<PartIndex>& part)
      : _surface(surface), _fans(fans), _smallest(smallest_angle), _part(part), _fan_of(fans.corners.size()) {
    for (std::int32_t fan = 0; fan < fans.count(); ++fan) {
      for (std::int32_t i = fans.first[fan]; i < fans.first[fan + 1]; ++i) _fan_of[fans.corners[i]] = fan;
    }
  }

  std::int32_t run() {
    std::int32_t moves = 0;
    for (std::int32_t fan = 0; fan < _fans.count(); ++fan) {
      FanWedge worst{-1, 0, 0, _smallest};
      visit_wedges(_surface, _fans, _part, fan, [&](const FanWedge& wedge) {
        if (wedge.angle < worst.angle) worst = wedge;
      });
      if (worst.fan >= 0 && widen(worst)) ++moves;
    }
    return moves;
  }

private:
  bool widen(const FanWedge& wedge) {
    std::vector<std::int32_t> triangles;
    const std::int32_t size = _fans.size(wedge.fan);
    for (std::int32_t i = wedge.from; i != wedge.to; i = _fans.closed[wedge.fan] ? (i + 1) % size : i + 1)
      triangles.push_back(_fans.corners[_fans.first[wedge.fan] + i] / 3);
    const std::int32_t mine = _part[triangles.front()];
    const double before = missing_around(triangles);
    double best = before * real_fall;
    std::int32_t target = -1;
    for (const std::int32_t edge : {wedge.from, wedge.to}) {
      const geometry::HalfEdge h = _fans.edge(wedge.fan, edge);
      if (_surface.twins[h] < 0) continue;
      // The part on the far side of the edge.
      const std::int32_t other = _part[h / 3] == mine ? _part[_surface.twins[h] / 3] : _part[h / 3];
      if (other == mine) continue;
      set(triangles, other);
      const double after = missing_around(triangles);
      if (after < best) {
        best = after;
        target = other;
      }
      set(triangles, mine);
    }
    if (target < 0) return false;
    set(triangles, target);
    return true;
  }

  void set(const std::vector<std::int32_t>& triangles, std::int32_t part) {
    for (const std::int32_t t : triangles) _part[t] = part;
  }

  /// Degrees that wedges around the corners of the triangles lack.
  double missing_around(const std::vector<std::int32_t>& triangles) const {
    std::vector<std::int32_t> fans;
    for (const std::int32_t t : triangles) {
      for (int i = 0; i < 3; ++i) fans.push_back(_fan_of[3 * t + i]);
    }
    geometry::sort_unique(fans);
    double missing = 0;
    for (const std::int32_t fan : fans) {
      visit_wedges(_surface, _fans, _part, fan,
                   [&](const FanWedge& wedge) { missing += std::max(0.0, _smallest - wedge.angle); });
    }
    return missing;
  }

  const BackgroundSurface& _surface;
  const VertexFans& _fans;
  double _smallest;
  std::vector<std::int32_t>& _part;
  std::vector<std::int32_t> _fan_of;  // per corner
};

/// Numbers the parts by first triangle; empty ones vanish.
PartIndex number_parts(std::vector<PartIndex>& part) {
  PartIndex parts = 0;
  std::vector<PartIndex> number(part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1, -1);
  for (PartIndex& p : part) {
    if (number[p] < 0) number[p] = parts++;
    p = number[p];
  }
  return parts;
}

}  // namespace

void connect_parts(const BackgroundSurface& surface, std::vector<PartIndex>& part) {
  const auto count = static_cast<std::int32_t>(surface.triangles.size());
  std::vector<std::int32_t> component(count, -1), stack;
  std::vector<double> loads;
  std::vector<std::int32_t> part_of;
  for (std::int32_t seed = 0; seed < count; ++seed) {
    if (component[seed] >= 0) continue;
    const auto number = static_cast<std::int32_t>(loads.size());
    loads.push_back(0);
    part_of.push_back(part[seed]);
    component[seed] = number;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      loads[number] += surface.loads[t];
      for (int i = 0; i < 3; ++i) {
        const geometry::HalfEdge twin = surface.twins[3 * t + i];
        if (twin < 0 || component[twin / 3] >= 0 || part[twin / 3] != part[t]) continue;
        component[twin / 3] = number;
        stack.push_back(twin / 3);
      }
    }
  }
  std::map<std::int32_t, std::int32_t> heaviest;  // component by part; the first of equals
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(loads.size()); ++c) {
    const auto [at, fresh] = heaviest.try_emplace(part_of[c], c);
    if (!fresh && loads[c] > loads[at->second]) at->second = c;
  }
  // Stray components join a neighbour that has a part; those in the second row wait for the first.
  std::vector<char> placed(loads.size(), 0);
  for (const auto& [p, c] : heaviest) placed[c] = 1;
  for (bool changed = true; changed;) {
    changed = false;
    std::map<std::array<std::int32_t, 2>, double> border;  // stray component, part on the other side: length
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(surface.twins.size()); ++h) {
      const geometry::HalfEdge twin = surface.twins[h];
      if (twin < 0 || placed[component[h / 3]] || !placed[component[twin / 3]]) continue;
      border[{component[h / 3], part_of[component[twin / 3]]}] +=
          distance(surface.points[surface.start(h)], surface.points[surface.end(h)]);
    }
    std::map<std::int32_t, std::pair<double, std::int32_t>> best;
    for (const auto& [key, length] : border) {
      const auto [at, fresh] = best.try_emplace(key[0], length, key[1]);
      if (!fresh && length > at->second.first) at->second = {length, key[1]};
    }
    for (const auto& [c, target] : best) {
      part_of[c] = target.second;
      placed[c] = 1;
      changed = true;
    }
  }
  for (std::int32_t t = 0; t < count; ++t) part[t] = part_of[component[t]];
}

std::int32_t widen_wedges(const BackgroundSurface& surface, const VertexFans& fans, double smallest_angle,
                          std::vector<PartIndex>& part) {
  return Widener(surface, fans, smallest_angle, part).run();
}

PartIndex repair_parts(const BackgroundSurface& surface, const VertexFans& fans, const RepairOptions& options,
                       std::vector<PartIndex>& part) {
  if (options.connects_parts) connect_parts(surface, part);
  for (int round = 0; round < repair_rounds && options.smallest_angle > 0; ++round) {
    const std::int32_t moves = widen_wedges(surface, fans, options.smallest_angle, part);
    if (options.connects_parts) connect_parts(surface, part);
    if (moves == 0) break;
  }
  return number_parts(part);
}

}  // namespace aeroloom::partition
