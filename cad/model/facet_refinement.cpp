#include "cad/model/facet_refinement.hpp"

#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::cad {
namespace {

constexpr int passes = 24;

/// A piece of a boundary line between two of its nodes.
struct BoundarySide {
  std::int32_t line;
  double low, high;  // parameters of the edge
  std::int32_t low_node, high_node;
  std::int32_t triangle = -1;
  int corner = -1;  // of the triangle, opposite the side
};

class Refiner {
public:
  Refiner(const Model& model, FaceId id, double deflection, double angle, Facets& facets)
      : _model(model),
        _id(id),
        _facets(facets),
        _deflection(deflection),
        _error_limit(1 - std::cos(0.5 * angle)),
        _most_triangles(20 * facets.triangles.size() + 20000) {
    for (const Vec2 uv : facets.uv) _normals.push_back(normal_at(uv));
    _pole.resize(facets.points.size(), 0);
    collect_sides();
    link_triangles();
    for (const auto& line : facets.boundary) {
      if (!_model.edge(line.use.edge).degenerate) continue;
      for (const std::int32_t node : line.nodes) _pole[node] = 1;
    }
  }

  void run() {
    for (std::int32_t t = 0; t < count(); ++t) push_sides(t);
    flip();
    for (int pass = 0; pass < passes && improve_once(); ++pass) {
    }
    store_lines();
    drop_unused();
  }

private:
  using Triangle = std::array<std::int32_t, 3>;

  bool improve_once() {
    std::vector<std::int32_t> bad;
    for (std::int32_t t = 0; t < count(); ++t) {
      if (is_bad(t)) bad.push_back(t);
    }
    bool changed = false;
    for (const std::int32_t t : bad) {
      if (_facets.triangles.size() >= _most_triangles) break;
      if (is_bad(t)) changed |= repair(t);
    }
    flip();
    return changed;
  }

  /// Flat triangles have no direction to speak of: a vertex between others in a row goes. Others are divided.
  bool repair(std::int32_t t) {
    if (is_flat(t) && contract(t)) return true;
    if (const std::int32_t side = encroached_side(t); side >= 0)
      return split_boundary(side) || split_longest(t);
    return split_longest(t);
  }

  bool alive(std::int32_t t) const { return _facets.triangles[t][0] >= 0; }
  std::int32_t count() const { return static_cast<std::int32_t>(_facets.triangles.size()); }
  Vec3 point(std::int32_t node) const { return _facets.points[node]; }
  Vec2 uv(std::int32_t node) const { return _facets.uv[node]; }

  /// Along du x dv, whichever way the face is turned; zero where undefined.
  Vec3 normal_at(Vec2 uv) const {
    const SurfaceFrame frame = _model.face_frame(_id, uv);
    return frame.normal == Vec3{} ? Vec3{} : normalized(cross(frame.du, frame.dv));
  }

  // --- topology: a link is the triangle across a side, or the complement of the index of a boundary side.

  void collect_sides() {
    for (std::size_t l = 0; l < _facets.boundary.size(); ++l) {
      const auto& line = _facets.boundary[l];
      for (std::size_t i = 1; i < line.nodes.size(); ++i) {
        add_side({static_cast<std::int32_t>(l), line.parameters[i - 1], line.parameters[i], line.nodes[i - 1],
                  line.nodes[i]});
      }
    }
  }

  std::int32_t add_side(const BoundarySide& side) {
    const auto index = static_cast<std::int32_t>(_sides.size());
    _sides.push_back(side);
    _side_at[{side.line, side.low}] = index;
    return index;
  }

  void link_triangles() {
    struct Entry {
      std::int32_t low, high, owner;  // owner: 3 * triangle + corner, or the complement of a boundary side
      bool operator<(const Entry& o) const {
        return std::tie(low, high, owner) < std::tie(o.low, o.high, o.owner);
      }
    };
    std::vector<Entry> entries;
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
          from, entries.end(), [&](const Entry& e) { return e.low != from->low || e.high != from->high; });
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

  std::int32_t corner(std::int32_t t, int i) const { return _facets.triangles[t][i % 3]; }

  void attach_side(std::int32_t side, std::int32_t t, int i) {
    _links[t][i] = ~side;
    _sides[side].triangle = t;
    _sides[side].corner = i;
  }

  /// Sets what lies across a side, and tells the other about it.
  void attach(std::int32_t t, int i, std::int32_t link) {
    if (link == no_link) {
      _links[t][i] = no_link;
    } else if (link < 0) {
      attach_side(~link, t, i);
    } else {
      _links[t][i] = link;
      _links[link][corner_opposite(link, corner(t, i + 1), corner(t, i + 2))] = t;
    }
  }

  int corner_opposite(std::int32_t t, std::int32_t a, std::int32_t b) const {
    for (int i = 0; i < 2; ++i) {
      if (corner(t, i) != a && corner(t, i) != b) return i;
    }
    return 2;
  }

  bool positive(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return orient2d(uv(a), uv(b), uv(c)) > 0;
  }

  /// Such triangles stay as they are: at a pole the parameters of the middle of a side say nothing of where
  /// it is.
  bool touches_pole(std::int32_t t) const {
    return is_pole(corner(t, 0)) || is_pole(corner(t, 1)) || is_pole(corner(t, 2));
  }
  bool is_pole(std::int32_t node) const { return _pole[node] != 0; }

  // --- geometry

  bool collapsed(std::int32_t t) const {
    for (int i = 0; i < 3; ++i) {
      if (distance(point(corner(t, i)), point(corner(t, i + 1))) <= 1e-6 * _deflection) return true;
    }
    return false;
  }

  /// 1 - cos of the angle between facet and surface, the largest at the corners.
  double error(std::int32_t a, std::int32_t b, std::int32_t c) const {
    const Vec3 normal = normalized(cross(point(b) - point(a), point(c) - point(a)));
    double largest = 0;
    for (const std::int32_t node : {a, b, c}) {
      if (_normals[node] != Vec3{}) largest = std::max(largest, 1 - dot(normal, _normals[node]));
    }
    return largest;
  }

  double error(std::int32_t t) const { return error(corner(t, 0), corner(t, 1), corner(t, 2)); }

  int longest_side(std::int32_t t) const {
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (side_length(t, i) > side_length(t, longest)) longest = i;
    }
    return longest;
  }

  double side_length(std::int32_t t, int i) const {
    return distance(point(corner(t, i + 1)), point(corner(t, i + 2)));
  }

  bool is_bad(std::int32_t t) const {
    if (!alive(t) || touches_pole(t)) return false;
    const double length = side_length(t, longest_side(t));
    if (collapsed(t) || length <= 0.1 * _deflection) return false;
    if (error(t) > _error_limit) return true;
    if (length <= _deflection) return false;
    const std::int32_t a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Vec3 middle = (point(a) + point(b) + point(c)) / 3.0;
    return distance(middle, _model.face_point(_id, (uv(a) + uv(b) + uv(c)) / 3.0)) > _deflection;
  }

  bool is_flat(std::int32_t t) const {
    const Vec3 a = point(corner(t, 0)), b = point(corner(t, 1)), c = point(corner(t, 2));
    const double longest = side_length(t, longest_side(t));
    return norm(cross(b - a, c - a)) < 0.1 * longest * longest;
  }

  /// A boundary side of the triangle that is nearly its longest: dividing another would crowd vertices along
  /// it.
  std::int32_t encroached_side(std::int32_t t) const {
    const double longest = side_length(t, longest_side(t));
    for (int i = 0; i < 3; ++i) {
      const std::int32_t link = _links[t][i];
      if (link < 0 && link != no_link && side_length(t, i) > 0.5 * longest) return ~link;
    }
    return -1;
  }

  std::int32_t add_node(Vec2 at, Vec3 place) {
    _pole.push_back(0);
    _facets.uv.push_back(at);
    _facets.points.push_back(place);
    _normals.push_back(normal_at(at));
    return static_cast<std::int32_t>(_facets.points.size()) - 1;
  }

  // --- division

  bool split_longest(std::int32_t t) {
    const int i = longest_side(t);
    const std::int32_t link = _links[t][i];
    if (link == no_link) return false;
    return link < 0 ? split_boundary(~link) : split_inside(t, i);
  }

  bool split_inside(std::int32_t t, int i) {
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

  std::int32_t add_triangle(const Triangle& triangle) {
    _facets.triangles.push_back(triangle);
    _links.push_back({no_link, no_link, no_link});
    return count() - 1;
  }

  /// The same piece of the edge as the face passes it the other time; -1 where there is none.
  std::int32_t partner(const BoundarySide& side) const {
    const EdgeUse& use = _facets.boundary[side.line].use;
    for (std::size_t l = 0; l < _facets.boundary.size(); ++l) {
      const EdgeUse& other = _facets.boundary[l].use;
      if (other.edge != use.edge || other.use == use.use) continue;
      const auto found = _side_at.find({static_cast<std::int32_t>(l), side.low});
      if (found != _side_at.end() && _sides[found->second].high == side.high) return found->second;
    }
    return -1;
  }

  bool split_boundary(std::int32_t s) {
    const std::int32_t other = partner(_sides[s]);
    if (!can_divide(s) || (other >= 0 && !can_divide(other))) return false;
    divide(s);
    if (other >= 0) divide(other);
    return true;
  }

  Vec2 middle_uv(const BoundarySide& side) const {
    return _model.edge_uv(_id, _facets.boundary[side.line].use, 0.5 * (side.low + side.high));
  }

  bool can_divide(std::int32_t s) const {
    const BoundarySide& side = _sides[s];
    const double middle = 0.5 * (side.low + side.high);
    if (side.triangle < 0 || !(middle > side.low && middle < side.high)) return false;
    const std::int32_t a = corner(side.triangle, side.corner), b = corner(side.triangle, side.corner + 1),
                       c = corner(side.triangle, side.corner + 2);
    const Vec2 at = middle_uv(side);
    return orient2d(uv(a), uv(b), at) > 0 && orient2d(uv(a), at, uv(c)) > 0;
  }

  void divide(std::int32_t s) {
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

  // --- contraction

  /// The triangles around an interior vertex, counter-clockwise from t; empty at the boundary.
  std::vector<std::int32_t> ring(std::int32_t t, std::int32_t vertex) const {
    std::vector<std::int32_t> around;
    std::int32_t at = t;
    do {
      around.push_back(at);
      at = _links[at][(index_of(at, vertex) + 1) % 3];
    } while (at >= 0 && at != t && around.size() < 64);
    return at == t ? around : std::vector<std::int32_t>{};
  }

  int index_of(std::int32_t t, std::int32_t vertex) const {
    const Triangle& triangle = _facets.triangles[t];
    return static_cast<int>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
  }

  /// Tries the vertex opposite the longest side first, each towards its nearer neighbour in the triangle
  /// first.
  bool contract(std::int32_t t) {
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

  bool contract(const std::vector<std::int32_t>& around, std::int32_t from, std::int32_t to) {
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

  /// Whether another triangle joins `to` to the ring: the contraction would lay two triangles on each other.
  bool pinches(const std::vector<std::int32_t>& moved, std::int32_t from, std::int32_t to) const {
    if (moved.empty()) return true;
    for (const std::int32_t t : moved) {
      const int i = index_of(t, from);
      const std::int32_t across = _links[t][i];
      if (across >= 0 && corner(across, corner_opposite(across, corner(t, i + 1), corner(t, i + 2))) == to)
        return true;
    }
    return false;
  }

  /// Removes a triangle with the side that is contracted; what lay across its two other sides meets.
  void take_out(std::int32_t t, std::int32_t from, std::int32_t to) {
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

  // --- reconnection

  void push_sides(std::int32_t t) {
    for (int i = 0; i < 3; ++i) {
      if (_links[t][i] >= 0) _stack.push_back({corner(t, i + 1), corner(t, i + 2), t});
    }
  }

  void flip() {
    // Each flip lowers an error or an angle sum; on curved quadrilaterals both may alternate, hence the
    // budget.
    std::size_t budget = 20 * _facets.triangles.size() + 100;
    while (!_stack.empty() && budget > 0) {
      const auto [b, c, t] = _stack.back();
      _stack.pop_back();
      --budget;
      if (!alive(t)) continue;
      const int i = corner_opposite(t, b, c);
      if (corner(t, i + 1) == b && corner(t, i + 2) == c && _links[t][i] >= 0 && should_flip(t, i))
        flip(t, i);
    }
    _stack.clear();
  }

  static double angle_at(Vec3 apex, Vec3 p, Vec3 q) {
    return std::atan2(norm(cross(p - apex, q - apex)), dot(p - apex, q - apex));
  }

  bool should_flip(std::int32_t t, int i) const {
    const std::int32_t u = _links[t][i];
    const std::int32_t a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
    const std::int32_t d = corner(u, corner_opposite(u, b, c));
    if (a == d || !positive(a, b, d) || !positive(a, d, c)) return false;
    if (touches_pole(t) || touches_pole(u)) return false;
    if (collapsed(t) || collapsed(u)) return false;
    if (distance(point(a), point(d)) <= 1e-6 * _deflection) return false;
    const double before = std::max(error(t), error(u)), after = std::max(error(a, b, d), error(a, d, c));
    if (std::max(before, after) > _error_limit) return after < before - 1e-6;
    return angle_at(point(a), point(b), point(c)) + angle_at(point(d), point(b), point(c)) >
           std::numbers::pi + 1e-6;
  }

  void flip(std::int32_t t, int i) {
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

  void store_lines() {
    for (auto& line : _facets.boundary) line.nodes.clear(), line.parameters.clear();
    for (const auto& [at, index] : _side_at) {
      const BoundarySide& side = _sides[index];
      auto& line = _facets.boundary[side.line];
      if (line.nodes.empty()) line.nodes.push_back(side.low_node), line.parameters.push_back(side.low);
      line.nodes.push_back(side.high_node);
      line.parameters.push_back(side.high);
    }
  }

  /// Takes out what contractions left behind, order kept.
  void drop_unused() {
    std::erase_if(_facets.triangles, [](const Triangle& t) { return t[0] < 0; });
    std::vector<std::int32_t> index(_facets.points.size(), -1);
    const auto visit = [&](auto&& action) {
      for (Triangle& t : _facets.triangles) std::for_each(t.begin(), t.end(), action);
      for (auto& line : _facets.boundary) std::for_each(line.nodes.begin(), line.nodes.end(), action);
    };
    visit([&](std::int32_t node) { index[node] = 0; });
    std::int32_t next = 0;
    for (std::size_t i = 0; i < index.size(); ++i) {
      if (index[i] < 0) continue;
      _facets.points[next] = _facets.points[i];
      _facets.uv[next] = _facets.uv[i];
      index[i] = next++;
    }
    _facets.points.resize(next);
    _facets.uv.resize(next);
    visit([&](std::int32_t& node) { node = index[node]; });
  }

  struct StackedSide {
    std::int32_t from, to, triangle;
  };
  static constexpr std::int32_t no_link = std::numeric_limits<std::int32_t>::min();

  const Model& _model;
  FaceId _id;
  Facets& _facets;
  double _deflection, _error_limit;
  std::size_t _most_triangles;
  std::vector<Vec3> _normals;
  std::vector<char> _pole;                          // by node
  std::vector<std::array<std::int32_t, 3>> _links;  // across the side opposite each corner
  std::vector<BoundarySide> _sides;
  std::map<std::pair<std::int32_t, double>, std::int32_t> _side_at;  // by line and lower parameter
  std::vector<StackedSide> _stack;
};

}  // namespace

void refine_facets(const Model& model, FaceId id, double deflection, double angle, Facets& facets) {
  Refiner(model, id, deflection, angle, facets).run();
}

}  // namespace aeroloom::cad
