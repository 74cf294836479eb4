#include "cad/faceted/facet_sheets.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aeroloom::cad {
namespace {

using geometry::HalfEdge;
using geometry::orient2d;

/// Triangles turn from the direction a sheet is projected along by 60 degrees at most, which stretches
/// lengths by two; a sheet has so many triangles at most, and its direction is the mean of so many. Chosen,
/// not measured.
constexpr double least_cosine = 0.5;
constexpr std::int32_t most_in_sheet = 4000, most_in_mean = 64;
/// Parameters are multiples of this part of the diagonal (rounded to a power of two), so that shifts are
/// exact.
constexpr int bits_of_diagonal = 42;
/// Between two sheets, over the width of the first.
constexpr double gap_of_sheets = 0.5;

/// The grid that parameters are rounded to.
class ParameterGrid {
public:
  explicit ParameterGrid(const std::vector<Vec3>& points) {
    const double diagonal = box_of_points(points).diagonal();
    _cell = std::ldexp(1.0,
                       std::ilogb(std::max(diagonal, std::numeric_limits<double>::min())) - bits_of_diagonal);
  }
  double operator()(double x) const { return std::nearbyint(x / _cell) * _cell; }
  double up(double x) const { return std::ceil(x / _cell) * _cell; }
  double cell() const { return _cell; }

private:
  double _cell;
};

Vec2 project_to_sheet(const FlatSheet& sheet, Vec3 point, const ParameterGrid& grid) {
  const Vec3 p = point - sheet.origin;
  return {grid(dot(p, sheet.e1)), grid(dot(p, sheet.e2))};
}

/// A triangle laid flat as it is, its height and base no less than a few cells of the grid.
CornerUv lay_flat(const std::array<Vec3, 3>& corners, const ParameterGrid& grid) {
  const double least = 4 * grid.cell();
  const Vec3 base = corners[1] - corners[0], other = corners[2] - corners[0];
  const double length = norm(base);
  const double along = length > 0 ? dot(base, other) / length : 0;
  const double height = length > 0 ? norm(cross(base, other)) / length : 0;
  return {Vec2{0, 0}, Vec2{std::max(grid(length), least), 0},
          Vec2{grid(along), std::max(grid(height), least)}};
}

FlatSheet facing(Vec3 normal, Vec3 origin) {
  FlatSheet sheet{origin, normalized(cross(farthest_axis(normal), normal)), {}};
  sheet.e2 = cross(normal, sheet.e1);
  return sheet;
}

struct BorderSegment {
  std::int32_t from, to;  // points
  Vec2 a, b;
};

bool lies_in_span(Vec2 a, Vec2 b, Vec2 p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

/// Whether two segments of a border meet elsewhere than in a common end.
bool segments_meet(const BorderSegment& s, const BorderSegment& t) {
  if (s.to == t.from || s.from == t.to) {
    if (s.from == t.to && s.to == t.from) return true;
    const bool s_first = s.to == t.from;
    const Vec2 before = s_first ? s.a : t.a, middle = s_first ? s.b : t.b, after = s_first ? t.b : s.b;
    return orient2d(before, middle, after) == 0 && dot(middle - before, after - middle) < 0;
  }
  const int c = orient2d(s.a, s.b, t.a), d = orient2d(s.a, s.b, t.b);
  const int a = orient2d(t.a, t.b, s.a), b = orient2d(t.a, t.b, s.b);
  if (c * d < 0 && a * b < 0) return true;
  return (c == 0 && lies_in_span(s.a, s.b, t.a)) || (d == 0 && lies_in_span(s.a, s.b, t.b)) ||
         (a == 0 && lies_in_span(t.a, t.b, s.a)) || (b == 0 && lies_in_span(t.a, t.b, s.b));
}

bool is_simple(const std::vector<BorderSegment>& border) {
  std::vector<Box> boxes;
  boxes.reserve(border.size());
  for (const BorderSegment& s : border) {
    Box& box = boxes.emplace_back();
    box.add(Vec3{s.a.x, s.a.y, 0}), box.add(Vec3{s.b.x, s.b.y, 0});
  }
  constexpr int leaf = 8;
  const geometry::BoxTree tree(boxes, leaf);
  bool simple = true;
  for (std::size_t i = 0; i < border.size() && simple; ++i) {
    geometry::for_each_overlap(tree, boxes, boxes[i], [&](std::int32_t j) {
      if (static_cast<std::size_t>(j) > i && segments_meet(border[i], border[j])) simple = false;
    });
  }
  return simple;
}

/// Grows sheets triangle by triangle, each a disk at every moment.
class SheetGrower {
public:
  SheetGrower(const FacetComplex& complex, const FacetLinks& links)
      : _complex(complex),
        _links(links),
        _grid(complex.points),
        _mark(complex.points.size(), -1),
        _uv(complex.points.size()),
        _seen(complex.triangles.size(), -1) {
    _result.of.assign(complex.triangles.size(), -1);
  }

  FacetSheets run() {
    for (std::int32_t seed = 0; seed < static_cast<std::int32_t>(_complex.triangles.size()); ++seed) {
      if (_result.of[seed] >= 0) continue;
      for (std::int32_t most = most_in_sheet;; most /= 2) {
        grow(seed, std::max(most, 1));
        if (_own.size() == 1 || (faces_forward(seed) && is_simple(border()))) break;
        for (const std::int32_t t : _own) _result.of[t] = -1;
      }
      _result.sheets.push_back(_sheet);
    }
    place();
    return std::move(_result);
  }

private:
  std::int32_t number() const { return static_cast<std::int32_t>(_result.sheets.size()); }

  Vec3 mean_normal(std::int32_t seed) {
    _waiting.assign(1, seed);
    _seen[seed] = seed;
    const Vec3 own = normalized(area_vector2(corners_of(_complex, seed)));
    Vec3 sum;
    for (std::size_t i = 0; i < _waiting.size(); ++i) {
      const Vec3 area = area_vector2(corners_of(_complex, _waiting[i]));
      if (dot(area, own) > 0) sum += area;
      for (int k = 0; k < 3 && static_cast<std::int32_t>(_waiting.size()) < most_in_mean; ++k) {
        const HalfEdge twin = _links.inside[3 * _waiting[i] + k];
        if (twin < 0 || _seen[twin / 3] == seed) continue;
        _seen[twin / 3] = seed;
        _waiting.push_back(twin / 3);
      }
    }
    return dot(normalized(sum), own) > least_cosine ? normalized(sum) : own;
  }

  void grow(std::int32_t seed, std::int32_t most) {
    const Vec3 axis = mean_normal(seed);
    _sheet = facing(axis, _complex.points[_complex.triangles[seed][0]]);
    ++_round;
    _own.clear();
    _waiting.clear();
    add(seed);
    for (std::size_t i = 0; i < _waiting.size() && static_cast<std::int32_t>(_own.size()) < most; ++i) {
      const std::int32_t t = _waiting[i];
      if (_result.of[t] < 0 && fits(t, axis)) add(t);
    }
  }

  void add(std::int32_t t) {
    _own.push_back(t);
    _result.of[t] = number();
    for (const std::int32_t p : _complex.triangles[t]) {
      _mark[p] = _round;
      _uv[p] = project_to_sheet(_sheet, _complex.points[p], _grid);
    }
    for (int i = 0; i < 3; ++i) {
      const HalfEdge twin = _links.inside[3 * t + i];
      if (twin >= 0 && _result.of[twin / 3] < 0) _waiting.push_back(twin / 3);
    }
  }

  /// Whether the sheet with the triangle is a disk, and the triangle seen from its right side.
  bool fits(std::int32_t t, Vec3 axis) const {
    int beside = 0, opposite = -1;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge twin = _links.inside[3 * t + i];
      if (twin < 0 || _result.of[twin / 3] != number()) continue;
      ++beside;
      opposite = _complex.triangles[t][(i + 2) % 3];
    }
    if (beside == 0 || beside == 3 || (beside == 1 && _mark[opposite] == _round)) return false;
    const auto corners = corners_of(_complex, t);
    const Vec3 area = area_vector2(corners);
    if (!(dot(area, axis) > least_cosine * norm(area))) return false;
    const auto at = [&](int i) { return project_to_sheet(_sheet, corners[i], _grid); };
    return orient2d(at(0), at(1), at(2)) > 0;
  }

  bool faces_forward(std::int32_t t) const {
    const auto& [a, b, c] = _complex.triangles[t];
    return orient2d(_uv[a], _uv[b], _uv[c]) > 0;
  }

  std::vector<BorderSegment> border() const {
    std::vector<BorderSegment> segments;
    for (const std::int32_t t : _own) {
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        const HalfEdge twin = _links.inside[h];
        if (twin >= 0 && _result.of[twin / 3] == number()) continue;
        const std::int32_t a = start_of(_complex, h), b = end_of(_complex, h);
        segments.push_back({a, b, _uv[a], _uv[b]});
      }
    }
    return segments;
  }

  /// Lays the sheets of each face side by side.
  void place() {
    const std::vector<CornerUv> uv = flatten(_complex, _result);
    for (FlatSheet& sheet : _result.sheets) {
      sheet.low = std::numeric_limits<double>::max();
      sheet.high = -sheet.low;
    }
    std::vector<FaceId> face(_result.sheets.size(), no_entity);
    for (std::size_t t = 0; t < uv.size(); ++t) {
      FlatSheet& sheet = _result.sheets[_result.of[t]];
      face[_result.of[t]] = _complex.face_of[t];
      for (const Vec2 at : uv[t])
        sheet.low = std::min(sheet.low, at.x), sheet.high = std::max(sheet.high, at.x);
    }
    double next = 0;
    for (std::size_t s = 0; s < face.size(); ++s) {
      if (s == 0 || face[s] != face[s - 1]) next = 0;
      FlatSheet& sheet = _result.sheets[s];
      sheet.shift = _grid.up(next - sheet.low);
      sheet.low += sheet.shift, sheet.high += sheet.shift;
      next = sheet.high + gap_of_sheets * (sheet.high - sheet.low);
    }
  }

  const FacetComplex& _complex;
  const FacetLinks& _links;
  ParameterGrid _grid;
  FacetSheets _result;
  FlatSheet _sheet;                 // that grows
  std::vector<std::int32_t> _own;   // its triangles
  std::vector<std::int32_t> _mark;  // per point, the last round in which it came to a sheet
  std::vector<Vec2> _uv;            // per point, in that sheet
  std::vector<std::int32_t> _seen, _waiting;
  std::int32_t _round = -1;
};

}  // namespace

FacetSheets cut_into_sheets(const FacetComplex& complex, const FacetLinks& links) {
  return SheetGrower(complex, links).run();
}

std::vector<CornerUv> flatten(const FacetComplex& complex, const FacetSheets& sheets) {
  const ParameterGrid grid(complex.points);
  std::vector<std::int32_t> members(sheets.sheets.size(), 0);
  for (const std::int32_t s : sheets.of) ++members[s];
  std::vector<CornerUv> uv(complex.triangles.size());
  for (std::size_t t = 0; t < uv.size(); ++t) {
    const FlatSheet& sheet = sheets.sheets[sheets.of[t]];
    const auto corners = corners_of(complex, static_cast<std::int32_t>(t));
    if (members[sheets.of[t]] == 1) uv[t] = lay_flat(corners, grid);
    for (int i = 0; i < 3 && members[sheets.of[t]] > 1; ++i)
      uv[t][i] = project_to_sheet(sheet, corners[i], grid);
    for (Vec2& at : uv[t]) at.x += sheet.shift;
  }
  return uv;
}

}  // namespace aeroloom::cad
