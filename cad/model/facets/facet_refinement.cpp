#include "cad/model/facets/facet_refinement.hpp"

#include "cad/model/facets/facet_refiner.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::cad {
namespace {

// Bounds that keep a face from being refined for ever where its surface has a crease that no facet can
// follow. A pass halves the worst facets, so that two dozen reach any deflection; chosen, not measured.
constexpr int passes = 24;
constexpr std::size_t most_growth = 20, least_allowance = 20000;
/// Facets whose longest side is shorter, over the deflection, are good however they are oriented: dividing
/// them gains nothing that anyone sees.
constexpr double shortest_side = 0.1;
/// Twice the area over the square of the longest side, below which a facet is mended by taking a point away.
constexpr double flat = 0.1;

}  // namespace

FacetRefiner::FacetRefiner(const Model& model, FaceId id, double deflection, double angle, Facets& facets)
    : _model(model),
      _id(id),
      _facets(facets),
      _deflection(deflection),
      _error_limit(1 - std::cos(0.5 * angle)),
      _most_triangles(most_growth * facets.triangles.size() + least_allowance) {
  for (const Vec2 uv : facets.uv) _normals.push_back(normal_at(uv));
  _pole.resize(facets.points.size(), 0);
  collect_sides();
  link_triangles();
  for (const auto& line : facets.boundary) {
    if (!_model.edge(line.use.edge).degenerate) continue;
    for (const std::int32_t node : line.nodes) _pole[node] = 1;
  }
}

void FacetRefiner::run() {
  for (std::int32_t t = 0; t < count(); ++t) push_sides(t);
  flip();
  for (int pass = 0; pass < passes && improve_once(); ++pass) {
  }
  store_lines();
  std::erase_if(_facets.triangles, [](const Triangle& t) { return t[0] < 0; });
  drop_unused_points(_facets);
}

bool FacetRefiner::improve_once() {
  std::vector<std::int32_t> bad;
  for (std::int32_t t = 0; t < count(); ++t) {
    if (has_become_bad(t)) bad.push_back(t);
  }
  bool changed = false;
  for (const std::int32_t t : bad) {
    if (_facets.triangles.size() >= _most_triangles) break;
    if (is_bad(t)) changed |= repair(t);
  }
  flip();
  return changed;
}

bool FacetRefiner::repair(std::int32_t t) {
  if (is_flat(t) && contract(t)) return true;
  if (const std::int32_t side = encroached_side(t); side >= 0)
    return split_boundary(side) || split_longest(t);
  return split_longest(t);
}

Vec3 FacetRefiner::normal_at(Vec2 uv) const {
  const SurfaceFrame frame = _model.face_frame(_id, uv);
  return frame.normal == Vec3{} ? Vec3{} : normalized(cross(frame.du, frame.dv));
}

bool FacetRefiner::positive(std::int32_t a, std::int32_t b, std::int32_t c) const {
  return orient2d(uv(a), uv(b), uv(c)) > 0;
}

bool FacetRefiner::touches_pole(std::int32_t t) const {
  return is_pole(corner(t, 0)) || is_pole(corner(t, 1)) || is_pole(corner(t, 2));
}

bool FacetRefiner::collapsed(std::int32_t t) const {
  for (int i = 0; i < 3; ++i) {
    if (distance(point(corner(t, i)), point(corner(t, i + 1))) <= collapsed_side * _deflection) return true;
  }
  return false;
}

double FacetRefiner::error(std::int32_t a, std::int32_t b, std::int32_t c) const {
  const Vec3 normal = normalized(cross(point(b) - point(a), point(c) - point(a)));
  double largest = 0;
  for (const std::int32_t node : {a, b, c}) {
    if (_normals[node] != Vec3{}) largest = std::max(largest, 1 - dot(normal, _normals[node]));
  }
  return largest;
}

int FacetRefiner::longest_side(std::int32_t t) const {
  int longest = 0;
  for (int i = 1; i < 3; ++i) {
    if (side_length(t, i) > side_length(t, longest)) longest = i;
  }
  return longest;
}

double FacetRefiner::side_length(std::int32_t t, int i) const {
  return distance(point(corner(t, i + 1)), point(corner(t, i + 2)));
}

bool FacetRefiner::is_bad(std::int32_t t) const {
  if (!alive(t) || touches_pole(t)) return false;
  const double length = side_length(t, longest_side(t));
  if (collapsed(t) || length <= shortest_side * _deflection) return false;
  if (error(t) > _error_limit) return true;
  if (length <= _deflection) return false;
  const std::int32_t a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
  const Vec3 middle = (point(a) + point(b) + point(c)) / 3.0;
  return distance(middle, _model.face_point(_id, (uv(a) + uv(b) + uv(c)) / 3.0)) > _deflection;
}

bool FacetRefiner::has_become_bad(std::int32_t t) {
  if (_good.size() < _facets.triangles.size()) _good.resize(_facets.triangles.size(), {-1, -1, -1});
  if (_good[t] == _facets.triangles[t]) return false;
  if (is_bad(t)) return true;
  _good[t] = _facets.triangles[t];
  return false;
}

bool FacetRefiner::is_flat(std::int32_t t) const {
  const Vec3 a = point(corner(t, 0)), b = point(corner(t, 1)), c = point(corner(t, 2));
  const double longest = side_length(t, longest_side(t));
  return norm(cross(b - a, c - a)) < flat * longest * longest;
}

std::int32_t FacetRefiner::encroached_side(std::int32_t t) const {
  const double longest = side_length(t, longest_side(t));
  for (int i = 0; i < 3; ++i) {
    const std::int32_t link = _links[t][i];
    if (link < 0 && link != no_link && side_length(t, i) > 0.5 * longest) return ~link;
  }
  return -1;
}

std::int32_t FacetRefiner::add_node(Vec2 at, Vec3 place) {
  _pole.push_back(0);
  _facets.uv.push_back(at);
  _facets.points.push_back(place);
  _normals.push_back(normal_at(at));
  return static_cast<std::int32_t>(_facets.points.size()) - 1;
}

bool FacetRefiner::split_longest(std::int32_t t) {
  const int i = longest_side(t);
  const std::int32_t link = _links[t][i];
  if (link == no_link) return false;
  return link < 0 ? split_boundary(~link) : split_inside(t, i);
}

bool FacetRefiner::split_inside(std::int32_t t, int i) {
  const std::int32_t u = _links[t][i];
  const std::int32_t a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
  const int j = corner_opposite(u, b, c);
  const std::int32_t d = corner(u, j);
  const Vec2 middle = 0.5 * (uv(b) + uv(c));
  if (orient2d(uv(a), uv(b), middle) <= 0 || orient2d(uv(a), middle, uv(c)) <= 0 ||
      orient2d(uv(d), uv(c), middle) <= 0 || orient2d(uv(d), middle, uv(b)) <= 0) {
    return false;
  }
  const std::int32_t m = add_node(middle, _model.face_point(_id, middle));
  const std::int32_t across_ca = _links[t][(i + 1) % 3], across_ab = _links[t][(i + 2) % 3];
  const std::int32_t across_bd = _links[u][(j + 1) % 3], across_dc = _links[u][(j + 2) % 3];
  const std::int32_t t2 = add_triangle({a, m, c}), u2 = add_triangle({d, m, b});
  _facets.triangles[t] = {a, b, m};
  _facets.triangles[u] = {d, c, m};
  _links[t] = {u2, t2, no_link};
  _links[t2] = {u, no_link, t};
  _links[u] = {t2, u2, no_link};
  _links[u2] = {t, no_link, u};
  attach(t, 2, across_ab);
  attach(t2, 1, across_ca);
  attach(u, 2, across_dc);
  attach(u2, 1, across_bd);
  for (const std::int32_t each : {t, t2, u, u2}) push_sides(each);
  return true;
}

std::int32_t FacetRefiner::add_triangle(const Triangle& triangle) {
  _facets.triangles.push_back(triangle);
  _links.push_back({no_link, no_link, no_link});
  return count() - 1;
}

std::int32_t FacetRefiner::partner(const BoundarySide& side) const {
  const Coedge& use = _facets.boundary[side.line].use;
  for (std::size_t l = 0; l < _facets.boundary.size(); ++l) {
    const Coedge& other = _facets.boundary[l].use;
    if (other.edge != use.edge || other.use == use.use) continue;
    const auto found = _side_at.find({static_cast<std::int32_t>(l), side.low});
    if (found != _side_at.end() && _sides[found->second].high == side.high) return found->second;
  }
  return -1;
}

bool FacetRefiner::split_boundary(std::int32_t s) {
  const std::int32_t other = partner(_sides[s]);
  if (!can_divide(s) || (other >= 0 && !can_divide(other))) return false;
  divide(s);
  if (other >= 0) divide(other);
  return true;
}

Vec2 FacetRefiner::middle_uv(const BoundarySide& side) const {
  return _model.edge_uv(_id, _facets.boundary[side.line].use, 0.5 * (side.low + side.high));
}

bool FacetRefiner::can_divide(std::int32_t s) const {
  const BoundarySide& side = _sides[s];
  const double middle = 0.5 * (side.low + side.high);
  if (side.triangle < 0 || !(middle > side.low && middle < side.high)) return false;
  const std::int32_t a = corner(side.triangle, side.corner), b = corner(side.triangle, side.corner + 1),
                     c = corner(side.triangle, side.corner + 2);
  const Vec2 at = middle_uv(side);
  return orient2d(uv(a), uv(b), at) > 0 && orient2d(uv(a), at, uv(c)) > 0;
}

void FacetRefiner::divide(std::int32_t s) {
  const BoundarySide side = _sides[s];
  const double middle = 0.5 * (side.low + side.high);
  const std::int32_t t = side.triangle;
  const int i = side.corner;
  const std::int32_t a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
  const std::int32_t m =
      add_node(middle_uv(side), _model.edge_point(_facets.boundary[side.line].use.edge, middle));
  _sides[s].high = middle, _sides[s].high_node = m;
  const std::int32_t s2 = add_side({side.line, middle, side.high, m, side.high_node});
  const std::int32_t across_ca = _links[t][(i + 1) % 3], across_ab = _links[t][(i + 2) % 3];
  const std::int32_t t2 = add_triangle({a, m, c});
  _facets.triangles[t] = {a, b, m};
  _links[t] = {no_link, t2, no_link};
  _links[t2] = {no_link, no_link, t};
  attach_side(b == side.low_node ? s : s2, t, 0);
  attach_side(b == side.low_node ? s2 : s, t2, 0);
  attach(t, 2, across_ab);
  attach(t2, 1, across_ca);
  push_sides(t);
  push_sides(t2);
}

void refine_facets(const Model& model, FaceId id, double deflection, double angle, Facets& facets) {
  FacetRefiner(model, id, deflection, angle, facets).run();
}

}  // namespace aeroloom::cad
