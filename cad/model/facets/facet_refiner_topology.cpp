#include "cad/model/facets/facet_refinement.hpp"
#include "cad/model/facets/facet_refiner.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <numbers>
#include <tuple>

namespace aeroloom::cad {
namespace {

/// Triangles around a vertex; where there are more it is a pole or the links do not close. Chosen, not
/// measured.
constexpr std::size_t most_around = 64;
/// A flip that lowers an error (1 minus a cosine) or raises a sum of angles (radians) by less is rounding,
/// and would be undone by the next. Chosen, not measured.
constexpr double least_gain = 1e-6;

}  // namespace

void FacetRefiner::collect_sides() {
  for (std::size_t l = 0; l < _facets.boundary.size(); ++l) {
    const auto& line = _facets.boundary[l];
    for (std::size_t i = 1; i < line.nodes.size(); ++i) {
      add_side({static_cast<std::int32_t>(l), line.parameters[i - 1], line.parameters[i], line.nodes[i - 1],
                line.nodes[i]});
    }
  }
}

std::int32_t FacetRefiner::add_side(const BoundarySide& side) {
  const auto index = static_cast<std::int32_t>(_sides.size());
  _sides.push_back(side);
  _side_at[{side.line, side.low}] = index;
  return index;
}

void FacetRefiner::link_triangles() {
  struct EdgeOwner {
    std::int32_t low, high, owner;  // owner: 3 * triangle + corner, or the complement of a boundary side
    bool operator<(const EdgeOwner& o) const {
      return std::tie(low, high, owner) < std::tie(o.low, o.high, o.owner);
    }
  };
  std::vector<EdgeOwner> entries;
  for (std::int32_t t = 0; t < count(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({corner(t, i + 1), corner(t, i + 2)});
      entries.push_back({low, high, 3 * t + i});
    }
  }
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    const auto [low, high] = std::minmax({_sides[s].low_node, _sides[s].high_node});
    entries.push_back({low, high, ~static_cast<std::int32_t>(s)});
  }
  std::sort(entries.begin(), entries.end());
  _links.assign(_facets.triangles.size(), {no_link, no_link, no_link});
  for (auto from = entries.begin(); from != entries.end();) {
    const auto to = std::find_if(
        from, entries.end(), [&](const EdgeOwner& e) { return e.low != from->low || e.high != from->high; });
    // Anything but two triangles, or a triangle and a boundary side, is left as it is: nothing is done
    // across it.
    if (to - from == 2 && from[1].owner >= 0) {
      const std::int32_t t = from[1].owner / 3;
      const int i = from[1].owner % 3;
      if (from->owner < 0) {
        attach_side(~from->owner, t, i);
      } else if (corner(t, i + 1) == corner(from->owner / 3, from->owner % 3 + 2)) {
        _links[from->owner / 3][from->owner % 3] = t;
        _links[t][i] = from->owner / 3;
      }
    }
    from = to;
  }
}

void FacetRefiner::attach_side(std::int32_t side, std::int32_t t, int i) {
  _links[t][i] = ~side;
  _sides[side].triangle = t;
  _sides[side].corner = i;
}

void FacetRefiner::attach(std::int32_t t, int i, std::int32_t link) {
  if (link == no_link) {
    _links[t][i] = no_link;
  } else if (link < 0) {
    attach_side(~link, t, i);
  } else {
    _links[t][i] = link;
    _links[link][corner_opposite(link, corner(t, i + 1), corner(t, i + 2))] = t;
  }
}

int FacetRefiner::corner_opposite(std::int32_t t, std::int32_t a, std::int32_t b) const {
  for (int i = 0; i < 2; ++i) {
    if (corner(t, i) != a && corner(t, i) != b) return i;
  }
  return 2;
}

std::vector<std::int32_t> FacetRefiner::ring(std::int32_t t, std::int32_t vertex) const {
  std::vector<std::int32_t> around;
  std::int32_t at = t;
  do {
    around.push_back(at);
    at = _links[at][(index_of(at, vertex) + 1) % 3];
  } while (at >= 0 && at != t && around.size() < most_around);
  return at == t ? around : std::vector<std::int32_t>{};
}

int FacetRefiner::index_of(std::int32_t t, std::int32_t vertex) const {
  const Triangle& triangle = _facets.triangles[t];
  return static_cast<int>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
}

bool FacetRefiner::contract(std::int32_t t) {
  const int longest = longest_side(t);
  for (int k = 0; k < 3; ++k) {
    const std::int32_t from = corner(t, longest + k);
    std::int32_t near = corner(t, longest + k + 1), far = corner(t, longest + k + 2);
    if (distance(point(from), point(far)) < distance(point(from), point(near))) std::swap(near, far);
    const std::vector<std::int32_t> around = ring(t, from);
    if (around.empty() || is_pole(near) || is_pole(far)) continue;
    if (contract(around, from, near) || contract(around, from, far)) return true;
  }
  return false;
}

bool FacetRefiner::contract(const std::vector<std::int32_t>& around, std::int32_t from, std::int32_t to) {
  double before = 0, after = 0;
  std::vector<std::int32_t> moved, taken;
  for (const std::int32_t t : around) {
    const int i = index_of(t, from);
    const std::int32_t a = corner(t, i + 1), b = corner(t, i + 2);
    before = std::max(before, error(t));
    (a == to || b == to ? taken : moved).push_back(t);
    if (a == to || b == to) continue;
    if (!positive(to, a, b)) return false;
    after = std::max(after, error(to, a, b));
  }
  if (taken.size() != 2 || after >= before || pinches(moved, from, to)) return false;
  for (const std::int32_t t : taken) take_out(t, from, to);
  for (const std::int32_t t : moved) _facets.triangles[t][index_of(t, from)] = to;
  for (const std::int32_t t : moved) push_sides(t);
  return true;
}

bool FacetRefiner::pinches(const std::vector<std::int32_t>& moved, std::int32_t from, std::int32_t to) const {
  if (moved.empty()) return true;
  for (const std::int32_t t : moved) {
    const int i = index_of(t, from);
    const std::int32_t across = _links[t][i];
    if (across >= 0 && corner(across, corner_opposite(across, corner(t, i + 1), corner(t, i + 2))) == to)
      return true;
  }
  return false;
}

void FacetRefiner::take_out(std::int32_t t, std::int32_t from, std::int32_t to) {
  const int at_from = index_of(t, from), at_to = index_of(t, to);
  const std::int32_t apex = corner(t, 3 - at_from - at_to);
  const std::int32_t inside = _links[t][at_to];     // shares the vertex that goes
  const std::int32_t outside = _links[t][at_from];  // shares the one that stays
  const int k = corner_opposite(inside, from, apex);
  if (outside == no_link) {
    _links[inside][k] = no_link;
  } else if (outside < 0) {
    attach_side(~outside, inside, k);
  } else {
    _links[inside][k] = outside;
    _links[outside][corner_opposite(outside, to, apex)] = inside;
  }
  _facets.triangles[t] = {-1, -1, -1};
  _links[t] = {no_link, no_link, no_link};
}

void FacetRefiner::push_sides(std::int32_t t) {
  for (int i = 0; i < 3; ++i) {
    if (_links[t][i] >= 0) _stack.push_back({corner(t, i + 1), corner(t, i + 2), t});
  }
}

void FacetRefiner::flip() {
  // Each flip lowers an error or an angle sum; on curved quadrilaterals both may alternate, hence the budget,
  // a multiple of what a Delaunay mesh takes. Chosen, not measured.
  std::size_t budget = 20 * _facets.triangles.size() + 100;
  while (!_stack.empty() && budget > 0) {
    const auto [b, c, t] = _stack.back();
    _stack.pop_back();
    --budget;
    if (!alive(t)) continue;
    const int i = corner_opposite(t, b, c);
    if (corner(t, i + 1) == b && corner(t, i + 2) == c && _links[t][i] >= 0 && should_flip(t, i)) flip(t, i);
  }
  _stack.clear();
}

bool FacetRefiner::should_flip(std::int32_t t, int i) const {
  const std::int32_t u = _links[t][i];
  const std::int32_t a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
  const std::int32_t d = corner(u, corner_opposite(u, b, c));
  if (a == d || !positive(a, b, d) || !positive(a, d, c)) return false;
  if (touches_pole(t) || touches_pole(u)) return false;
  if (collapsed(t) || collapsed(u)) return false;
  if (distance(point(a), point(d)) <= collapsed_side * _deflection) return false;
  const double before = std::max(error(t), error(u)), after = std::max(error(a, b, d), error(a, d, c));
  if (std::max(before, after) > _error_limit) return after < before - least_gain;
  return angle_between(point(b) - point(a), point(c) - point(a)) +
             angle_between(point(b) - point(d), point(c) - point(d)) >
         std::numbers::pi + least_gain;
}

void FacetRefiner::flip(std::int32_t t, int i) {
  const std::int32_t u = _links[t][i];
  const std::int32_t a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
  const int j = corner_opposite(u, b, c);
  const std::int32_t d = corner(u, j);
  const std::int32_t across_ca = _links[t][(i + 1) % 3], across_ab = _links[t][(i + 2) % 3];
  const std::int32_t across_bd = _links[u][(j + 1) % 3], across_dc = _links[u][(j + 2) % 3];
  _facets.triangles[t] = {a, b, d};
  _facets.triangles[u] = {a, d, c};
  _links[t] = {no_link, u, no_link};
  _links[u] = {no_link, no_link, t};
  attach(t, 0, across_bd);
  attach(t, 2, across_ab);
  attach(u, 0, across_dc);
  attach(u, 1, across_ca);
  push_sides(t);
  push_sides(u);
}

void FacetRefiner::store_lines() {
  for (auto& line : _facets.boundary) line.nodes.clear(), line.parameters.clear();
  for (const auto& [at, index] : _side_at) {
    const BoundarySide& side = _sides[index];
    auto& line = _facets.boundary[side.line];
    if (line.nodes.empty()) line.nodes.push_back(side.low_node), line.parameters.push_back(side.low);
    line.nodes.push_back(side.high_node);
    line.parameters.push_back(side.high);
  }
}

void drop_unused_points(Facets& facets) {
  std::vector<std::int32_t> index(facets.points.size(), -1);
  const auto visit = [&](auto&& action) {
    for (auto& t : facets.triangles) std::for_each(t.begin(), t.end(), action);
    for (auto& line : facets.boundary) std::for_each(line.nodes.begin(), line.nodes.end(), action);
  };
  visit([&](std::int32_t node) { index[node] = 0; });
  std::int32_t next = 0;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    facets.points[next] = facets.points[i];
    facets.uv[next] = facets.uv[i];
    index[i] = next++;
  }
  facets.points.resize(next);
  facets.uv.resize(next);
  visit([&](std::int32_t& node) { node = index[node]; });
}

}  // namespace aeroloom::cad
