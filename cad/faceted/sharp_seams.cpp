#include "cad/faceted/facet_links.hpp"
#include "cad/faceted/facet_sheets.hpp"
#include "cad/model/library_unit.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::HalfEdge;

/// A division leaves a curve with the same face on both sides only where it is short next to the triangles;
/// the next round looks at what is left.
constexpr int most_rounds = 8;

Vec3 centre_of_triangle(const FacetComplex& complex, std::int32_t triangle) {
  const auto corners = corners_of(complex, triangle);
  return (corners[0] + corners[1] + corners[2]) / 3;
}

/// Per curve and face, whether it is passed along and against: bit 0 and bit 1.
using Passes = std::map<std::pair<FaceId, std::int32_t>, int>;

Passes find_passes(const FacetComplex& complex, const FacetLinks& links) {
  Passes passes;
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(links.on_curve.size()); ++h) {
    const CurveSide& side = links.on_curve[h];
    if (side.curve != no_entity) passes[{complex.face_of[h / 3], side.curve}] |= side.along ? 1 : 2;
  }
  std::erase_if(passes, [](const auto& each) { return each.second != 3; });
  return passes;
}

/// Per triangle of the faces to divide, the side of a curve that is nearest over the face: twice the curve,
/// and one more where the curve runs the other way; -1 elsewhere.
std::vector<std::int32_t> label_by_side(const FacetComplex& complex, const FacetLinks& links,
                                        const Passes& passes) {
  using Entry = std::tuple<double, std::int32_t, std::int32_t>;  // length of the way, label, triangle
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<std::int32_t> label(complex.triangles.size(), -1);
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(links.on_curve.size()); ++h) {
    const CurveSide& side = links.on_curve[h];
    if (side.curve == no_entity || !passes.contains({complex.face_of[h / 3], side.curve})) continue;
    const Vec3 middle = 0.5 * (complex.points[start_of(complex, h)] + complex.points[end_of(complex, h)]);
    queue.emplace(distance(middle, centre_of_triangle(complex, h / 3)), 2 * side.curve + (side.along ? 0 : 1),
                  h / 3);
  }
  while (!queue.empty()) {
    const auto [way, side, t] = queue.top();
    queue.pop();
    if (label[t] >= 0) continue;
    label[t] = side;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge twin = links.inside[3 * t + i];
      if (twin < 0 || label[twin / 3] >= 0) continue;
      queue.emplace(way + distance(centre_of_triangle(complex, t), centre_of_triangle(complex, twin / 3)),
                    side, twin / 3);
    }
  }
  return label;
}

/// Straightens the borders between labels: what has two of its sides on one joins the label beyond, which
/// makes the border shorter, so that over needles it does not run to and fro. Triangles on curves that are
/// passed twice stay.
void straighten_borders(const FacetComplex& complex, const FacetLinks& links, const Passes& passes,
                        std::vector<std::int32_t>& label) {
  const auto stays = [&](std::int32_t t) {
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (links.inside[h] < 0 && passes.contains({complex.face_of[t], links.on_curve[h].curve})) return true;
    }
    return false;
  };
  const auto beyond = [&](HalfEdge h) { return links.inside[h] < 0 ? -1 : label[links.inside[h] / 3]; };
  std::vector<std::int32_t> waiting(label.size());
  std::iota(waiting.rbegin(), waiting.rend(), 0);
  while (!waiting.empty()) {
    const std::int32_t t = waiting.back();
    waiting.pop_back();
    if (label[t] < 0 || stays(t)) continue;
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      const std::int32_t other = beyond(h);
      if (other < 0 || other == label[t] || beyond(geometry::next_half_edge(h)) != other) continue;
      label[t] = other;
      for (HalfEdge side = 3 * t; side < 3 * t + 3; ++side) {
        if (links.inside[side] >= 0) waiting.push_back(links.inside[side] / 3);
      }
      break;
    }
  }
}

/// Numbers faces anew: components of equal label; the first one of a face keeps its number.
void split_faces(FacetComplex& complex, const FacetLinks& links, const std::vector<std::int32_t>& label) {
  std::vector<FaceId> part(complex.triangles.size(), no_entity);
  std::vector<char> used(complex.faces.size(), 0);
  std::vector<std::int32_t> waiting;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (part[seed] != no_entity) continue;
    const FaceId before = complex.face_of[seed];
    FaceId now = before;
    if (used[before]) {
      now = static_cast<FaceId>(complex.faces.size());
      complex.faces.push_back(FacetComplex::Face(complex.faces[before]));
    }
    used[before] = 1;
    part[seed] = now;
    waiting.assign(1, static_cast<std::int32_t>(seed));
    while (!waiting.empty()) {
      const std::int32_t t = waiting.back();
      waiting.pop_back();
      for (int i = 0; i < 3; ++i) {
        const HalfEdge twin = links.inside[3 * t + i];
        if (twin < 0 || part[twin / 3] != no_entity || label[twin / 3] != label[t]) continue;
        part[twin / 3] = now;
        waiting.push_back(twin / 3);
      }
    }
  }
  complex.face_of = std::move(part);
}

/// Sides between faces, and of the curves there are, joined to chains between vertices again.
class CurveJoiner {
public:
  explicit CurveJoiner(const FacetComplex& complex) : _at(complex.points.size()) {
    for (const auto& curve : complex.curves) {
      for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) add(curve.points[i], curve.points[i + 1]);
    }
    _is_vertex.assign(complex.points.size(), 0);
    for (const std::int32_t v : complex.vertices) _is_vertex[v] = 1;
  }
  void add(std::int32_t from, std::int32_t to) {
    const auto side = static_cast<std::int32_t>(_sides.size());
    _sides.push_back({from, to});
    _at[from].push_back(side), _at[to].push_back(side);
  }

  void trace(FacetComplex& complex) {
    for (std::size_t p = 0; p < _at.size(); ++p) {
      if (!_at[p].empty() && _at[p].size() != 2) _is_vertex[p] = 1;
    }
    _used.assign(_sides.size(), 0);
    complex.curves.clear();
    for (std::size_t p = 0; p < _at.size(); ++p) {
      if (_is_vertex[p]) leave(static_cast<std::int32_t>(p), complex);
    }
    for (std::size_t p = 0; p < _at.size(); ++p) {
      const bool closed_without =
          std::any_of(_at[p].begin(), _at[p].end(), [&](auto s) { return !_used[s]; });
      if (!closed_without) continue;
      _is_vertex[p] = 1;
      leave(static_cast<std::int32_t>(p), complex);
    }
    complex.vertices.clear();
    for (std::size_t p = 0; p < _at.size(); ++p) {
      if (_is_vertex[p]) complex.vertices.push_back(static_cast<std::int32_t>(p));
    }
  }

private:
  /// All chains that begin at a vertex.
  void leave(std::int32_t vertex, FacetComplex& complex) {
    for (const std::int32_t first : _at[vertex]) {
      if (_used[first]) continue;
      FacetComplex::Curve curve{{vertex}};
      std::int32_t side = first, at = vertex;
      do {
        _used[side] = 1;
        at = _sides[side][0] == at ? _sides[side][1] : _sides[side][0];
        curve.points.push_back(at);
        side = _at[at].front() == side ? _at[at].back() : _at[at].front();
      } while (!_is_vertex[at]);
      complex.curves.push_back(std::move(curve));
    }
  }

  std::vector<std::array<std::int32_t, 2>> _sides;
  std::vector<std::vector<std::int32_t>> _at;  // per point
  std::vector<char> _is_vertex, _used;
};

void sort_triangles_by_face(FacetComplex& complex) {
  std::vector<std::int32_t> order(complex.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(
      order, [&](std::int32_t a, std::int32_t b) { return complex.face_of[a] < complex.face_of[b]; });
  auto triangles = complex.triangles;
  auto face_of = complex.face_of;
  for (std::size_t i = 0; i < order.size(); ++i) {
    triangles[i] = complex.triangles[order[i]];
    face_of[i] = complex.face_of[order[i]];
  }
  complex.triangles = std::move(triangles);
  complex.face_of = std::move(face_of);
}

}  // namespace

void divide_at_sharp_seams(FacetComplex& complex) {
  for (int round = 0;; ++round) {
    const FacetLinks links = link_facets(complex);
    const Passes passes = find_passes(complex, links);
    if (passes.empty()) break;
    if (round == most_rounds) {
      const auto& [face, curve] = passes.begin()->first;
      throw CadError(fmt::format(
          "a sharp edge from {} has face '{}' on both sides, which cannot be divided. Remedy: "
          "another geometry.feature_angle, or finer triangles there",
          place_in_file(complex.points[complex.curves[curve].points.front()]), complex.faces[face].name));
    }
    std::vector<std::int32_t> label = label_by_side(complex, links, passes);
    straighten_borders(complex, links, passes, label);
    split_faces(complex, links, label);
    CurveJoiner tracer(complex);
    for (HalfEdge h = 0; h < static_cast<HalfEdge>(links.inside.size()); ++h) {
      const HalfEdge twin = links.inside[h];
      if (twin > h && complex.face_of[h / 3] != complex.face_of[twin / 3])
        tracer.add(start_of(complex, h), end_of(complex, h));
    }
    tracer.trace(complex);
  }
  sort_triangles_by_face(complex);
}

}  // namespace aeroloom::cad
