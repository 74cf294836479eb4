#include "layers/ridges.hpp"

#include "layers/cone.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

// The bounds of this file are chosen, not measured.

/// Sides whose normals differ by more have no direction of their own.
constexpr double least_cone = 0.1;
constexpr double most_turn = 1.15 * std::numbers::pi;
constexpr std::size_t most_edges = 8;
/// A triangle beside an edge that reaches another CAD edge is of a strip, as a blunt edge one triangle wide.
/// Between upright columns it would stay as narrow all the way up; so these lean apart, by this angle where
/// it is flat, and less up to where it is as high as this, in edges.
constexpr double most_lean = std::numbers::pi / 9, flat_height = 0.2, high_height = 0.6;

class RidgeFinder {
public:
  RidgeFinder(const StarCentre& centre, std::span<const StarTriangle> star)
      : _centre(centre), _vertex(centre.point), _star(star), _plane(centre.plane) {}

  std::optional<Ridge> find(std::vector<RidgeSide>& sides) {
    for (std::size_t i = 0; i < _star.size(); ++i) {
      if (is_sharp(i)) _edges.push_back(i);
    }
    const bool is_half = !(_plane == Vec3{}) && _edges.empty() && find_half();
    _ridge.on_plane = !(_plane == Vec3{}) && !is_half;
    const bool goes_on = _ridge.on_plane ? _edges.size() == 1 : _edges.size() > 1;
    if (!goes_on || _edges.size() > most_edges) return std::nullopt;
    _ridge.lowest = {_star[0].piece, _star[0].cell};
    for (const StarTriangle& t : _star)
      _ridge.lowest = std::min(_ridge.lowest, TrianglePlace{t.piece, t.cell});
    sides.assign(_star.size(), 0);
    if (!(is_half ? part_half(sides) : part(sides)) || !(_ridge.is_corner() ? turn_by_edge() : turn_along()))
      return std::nullopt;
    return std::move(_ridge);
  }

private:
  /// Edge i starts before triangle i.
  const StarTriangle& left(std::size_t edge) const { return _star[edge]; }
  const StarTriangle& right(std::size_t edge) const {
    return _star[(edge + _star.size() - 1) % _star.size()];
  }
  Vec3 along(std::size_t edge) const { return normalized(left(edge).next_point - _vertex); }

  /// Whether both triangles at an edge are the sides of one: it is the free rim of a baffle.
  bool is_rim(std::size_t edge) const { return left(edge).previous_point == right(edge).next_point; }

  bool is_sharp(std::size_t edge) const {
    const StarTriangle &l = left(edge), &r = right(edge);
    if (r.wall_role() != WallRole::layered || l.wall_role() != WallRole::layered) return false;
    if (is_rim(edge)) return true;
    return dot(r.normal, l.normal) < least_cosine(edge) &&
           dot(cross(r.normal, l.normal), l.next_point - _vertex) < 0;
  }

  /// The cosine of the least turn of a ridge at an edge; -1 where none may be.
  double least_cosine(std::size_t edge) const {
    const auto turn = static_cast<EdgeTurn>(left(edge).edge_turn);
    if (!may_be_ridge(_centre.turn) || !may_be_ridge(turn)) return -1;
    // An edge within a face may lead from one sharp CAD edge to another.
    const bool is_sharp =
        (turn == EdgeTurn::sharp || _centre.turn == EdgeTurn::sharp) && left(edge).face != right(edge).face;
    return std::cos(is_sharp ? least_turn : sharp_turn);
  }

  /// Whether the wall turns sharply into its mirror image at both edges that it has in the plane, which then
  /// are the ridge's.
  bool find_half() {
    std::vector<std::size_t> edges;
    for (std::size_t i = 0; i < _star.size(); ++i) {
      const StarTriangle &l = left(i), &r = right(i);
      if (l.wall_role() == r.wall_role()) continue;
      const double towards = dot((is_layered(l) ? l : r).normal, _plane);
      if (towards >= 0 || 1 - 2 * towards * towards >= least_cosine(i)) return false;
      edges.push_back(i);
    }
    if (edges.size() != 2) return false;
    _edges = std::move(edges);
    return true;
  }
  static bool is_layered(const StarTriangle& t) { return t.wall_role() == WallRole::layered; }

  /// How the column over the side on the left or right of an edge leans away from it, as a vector along the
  /// wall as long as the angle's tangent.
  Vec3 lean_at(std::size_t edge, bool on_left) const {
    const std::size_t n = _star.size();
    const StarTriangle& beside = on_left ? left(edge) : right(edge);
    const StarTriangle& apex = _star[on_left ? (edge + 1) % n : (edge + n - 1) % n];
    if (beside.wall_role() != WallRole::layered || static_cast<EdgeTurn>(apex.edge_turn) == EdgeTurn::smooth)
      return {};
    const Vec3 side = left(edge).next_point - _vertex;
    const double height = norm(cross(side, apex.next_point - _vertex)) / dot(side, side);
    const double part = std::clamp((high_height - height) / (high_height - flat_height), 0.0, 1.0);
    const Vec3 outwards = normalized(cross(side, beside.normal));
    return std::tan(part * most_lean) * (on_left ? outwards : -outwards);
  }

  /// Turns from the left to the right of an edge, each with a direction at right angles to it.
  static Ridge::Turn turn_about(Vec3 along, Vec3 left, Vec3 right) {
    const auto at_right_angles = [&](Vec3 direction) {
      return normalized(direction - dot(direction, along) * along);
    };
    Ridge::Turn turn;
    turn.normal = at_right_angles(left);
    turn.across = cross(along, turn.normal);
    const Vec3 last = at_right_angles(right);
    turn.angle = std::atan2(dot(last, turn.across), dot(last, turn.normal));
    if (turn.angle < 0) turn.angle += 2 * std::numbers::pi;
    return turn;
  }
  static bool is_sound(const Ridge::Turn& turn) {
    return turn.angle >= 0.5 * least_turn && turn.angle <= most_turn;
  }

  /// Parts the star at the edges.
  bool part(std::vector<RidgeSide>& sides) {
    const std::size_t n = _star.size();
    std::vector<std::vector<Vec3>> normals(1);
    for (std::size_t step = 0; step < n; ++step) {
      const std::size_t i = (_edges[0] + step) % n;
      const bool was_plane = step > 0 && right(i).wall_role() == WallRole::plane;
      if (_star[i].wall_role() == WallRole::plane) {
        if (normals.size() > 1) return false;
        sides[i] = side_of_plane;
        _ridge.plane_face = _star[i].face, _ridge.plane_patch = _star[i].patch;
        _ridge.last_of_plane = {_star[i].piece, _star[i].cell}, _ridge.rim = _star[i].previous;
        continue;
      }
      const bool at_edge = step > 0 && std::find(_edges.begin(), _edges.end(), i) != _edges.end();
      if (at_edge || was_plane) normals.emplace_back();
      sides[i] = static_cast<RidgeSide>(normals.size() - 1);
      normals.back().push_back(_star[i].normal);
    }
    if (normals.size() != (_ridge.on_plane ? 2 : _edges.size())) return false;
    for (const std::vector<Vec3>& of_side : normals) {
      const NormalCone cone = smallest_cone(of_side);
      _ridge.cone = std::min(_ridge.cone, cone.visibility);
      _ridge.sides.push_back(cone.axis);
    }
    lean_over_strips(normals);
    for (std::size_t e = 0; e < _edges.size(); ++e) {
      const StarTriangle &l = left(_edges[e]), &r = right(_edges[e]);
      _ridge.edges.push_back({l.next, {r.piece, r.cell}, {l.piece, l.cell}, along(_edges[e])});
    }
    return _ridge.cone >= least_cone;
  }

  /// The same in a plane.
  bool part_half(std::vector<RidgeSide>& sides) {
    const std::size_t n = _star.size(), wall = is_layered(left(_edges[0])) ? 0 : 1;
    std::vector<std::vector<Vec3>> normals(2);
    Vec3 over_plane;
    for (std::size_t i = 0; i < n; ++i) {
      sides[i] = static_cast<RidgeSide>(is_layered(_star[i]) ? wall : 1 - wall);
      if (is_layered(_star[i])) normals[wall].push_back(_star[i].normal);
    }
    for (const std::size_t edge : _edges) {
      const StarTriangle& of_wall = is_layered(left(edge)) ? left(edge) : right(edge);
      over_plane += normalized(of_wall.normal - dot(of_wall.normal, _plane) * _plane);
      _ridge.edges.push_back(
          {left(edge).next, {of_wall.piece, of_wall.cell}, {of_wall.piece, of_wall.cell}, along(edge)});
    }
    const NormalCone cone = smallest_cone(normals[wall]);
    _ridge.cone = cone.visibility;
    _ridge.sides.assign(2, cone.axis);
    _ridge.sides[1 - wall] = normalized(over_plane);
    _ridge.half_side = static_cast<std::int32_t>(1 - wall);
    return _ridge.cone >= least_cone && norm(over_plane) > 1;
  }

  /// Columns over strips lean apart.
  void lean_over_strips(const std::vector<std::vector<Vec3>>& normals) {
    for (std::size_t side = 0; side < _ridge.sides.size(); ++side) {
      Vec3 lean;
      const auto add = [&](std::size_t edge, bool on_left) {
        const Vec3 here = lean_at(_edges[edge], on_left);
        if (norm(here) > norm(lean)) lean = here;
      };
      const std::size_t on_right = (side + 1) % _ridge.sides.size();
      if (side < _edges.size()) add(side, true);
      if (on_right < _edges.size()) add(on_right, false);
      if (lean == Vec3{}) continue;
      Vec3& column = _ridge.sides[side];
      column = normalized(column + lean);
      for (const Vec3 normal : normals[side]) _ridge.cone = std::min(_ridge.cone, dot(column, normal));
    }
  }

  /// One turn, from side to side: on a plane about the edge, else at right angles to the bisector of both.
  bool turn_along() {
    constexpr double least_passing = 0.02;  // cosine between edge and plane's normal
    constexpr double least_mitre = 0.5;     // cosine of half the bend; columns get twice as long at most
    if (_ridge.on_plane) {
      const Vec3 first = _ridge.edges[0].direction;
      _ridge.plane = _plane;
      const double passing = dot(first, _plane);
      Vec3 about = first;
      if (std::abs(passing) < least_mitre) {
        // As if its mirror image went on beyond the plane.
        about = passing < 0 ? -_plane : _plane;
        _ridge.mitre = std::sqrt(1 / least_mitre - 1) * normalized(first - passing * _plane);
      }
      _ridge.turns.push_back(turn_about(about, _ridge.sides[0], _ridge.sides[1]));
      return is_sound(_ridge.turns[0]) && std::abs(passing) > least_passing;
    }
    const Vec3 first = _ridge.edges[0].direction, second = _ridge.edges[1].direction, bend = first + second;
    const double cosine = std::sqrt(std::max(0.0, 1 - 0.25 * dot(bend, bend)));
    if (cosine == 0) return false;
    if (norm(bend) > 0) _ridge.mitre = std::sqrt(1 / std::max(cosine, least_mitre) - 1) * normalized(bend);
    _ridge.turns.push_back(turn_about(normalized(first - second), _ridge.sides[0], _ridge.sides[1]));
    return is_sound(_ridge.turns[0]);
  }

  bool turn_by_edge() {
    for (const std::size_t edge : _edges) {
      _ridge.turns.push_back(turn_about(along(edge), left(edge).normal, right(edge).normal));
      if (!is_sound(_ridge.turns.back())) return false;
    }
    return true;
  }

  const StarCentre& _centre;
  Vec3 _vertex;
  std::span<const StarTriangle> _star;
  Vec3 _plane;
  std::vector<std::size_t> _edges;  // in order from the first
  Ridge _ridge;
};

}  // namespace

Vec3 Ridge::Turn::direction(double at) const {
  return std::cos(at) * normal + std::sin(at) * across;
}

std::optional<Ridge> find_ridge(const StarCentre& centre, std::span<const StarTriangle> star,
                                std::vector<RidgeSide>& sides) {
  return RidgeFinder(centre, star).find(sides);
}

}  // namespace aeroloom::layers
