// Narrow faces: where two edges of a face come closer than its elements are large.
#include "sizing/model_sources.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace aeroloom::sizing {
namespace {

using cad::Facets;
using geometry::Vec3;

constexpr int deepest_bisection = 40;

/// Where on the segment, from 0 to 1, the nearest point is.
double part_along(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double square = dot(along, along);
  return square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
}

double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  return distance(p, a + part_along(p, a, b) * (b - a));
}

/// The boundary lines of one face, which of them lie opposite each other, and how far apart.
class Strips {
public:
  Strips(const cad::Model& model, const Facets& facets, const SizingOptions& options)
      : _model(model), _facets(facets), _options(options) {}

  std::vector<SizeSource> run() {
    for (const auto& [from, to] : facing_lines()) {
      const auto& nodes = _facets.boundary[from].nodes;
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const Vec3 a = _facets.points[nodes[i]], b = _facets.points[nodes[i + 1]];
        cover(a, width(a, to), b, width(b, to), to, 0);
      }
    }
    return std::move(_sources);
  }

private:
  /// Pairs of lines without a common vertex that some facet joins, or the facets around a point inside, in
  /// both orders.
  std::set<std::pair<int, int>> facing_lines() const {
    std::vector<std::vector<int>> lines_of(_facets.points.size());
    for (std::size_t line = 0; line < _facets.boundary.size(); ++line) {
      if (_model.is_seam(_facets.boundary[line].use.edge)) continue;  // carries no elements
      for (const std::int32_t node : _facets.boundary[line].nodes)
        lines_of[node].push_back(static_cast<int>(line));
    }
    std::set<std::pair<int, int>> pairs;
    const auto join = [&](const auto& first, const auto& second) {
      for (const int a : first) {
        for (const int b : second) {
          if (a != b && !share_vertex(a, b)) pairs.insert({a, b}), pairs.insert({b, a});
        }
      }
    };
    std::vector<std::set<int>> lines_around(_facets.points.size());
    for (const auto& t : _facets.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t from = t[i], to = t[(i + 1) % 3];
        join(lines_of[from], lines_of[to]);
        for (const auto& [inner, other] : {std::pair{from, to}, std::pair{to, from}}) {
          if (lines_of[inner].empty())
            lines_around[inner].insert(lines_of[other].begin(), lines_of[other].end());
        }
      }
    }
    for (const auto& lines : lines_around) join(lines, lines);
    add_pairs_behind_ends(pairs);
    return pairs;
  }

  /// Where the short end of a strip has nodes of its own, no facet joins the long sides: they are facing if
  /// facets lie between the places where they are nearest.
  void add_pairs_behind_ends(std::set<std::pair<int, int>>& pairs) const {
    std::vector<int> lines;
    std::vector<geometry::Box> boxes(_facets.boundary.size());
    for (std::size_t line = 0; line < _facets.boundary.size(); ++line) {
      const auto& nodes = _facets.boundary[line].nodes;
      if (nodes.size() < 2 || _model.is_seam(_facets.boundary[line].use.edge)) continue;
      lines.push_back(static_cast<int>(line));
      for (const std::int32_t node : nodes) boxes[line].add(_facets.points[node]);
    }
    for (const int a : lines) {
      for (const int b : lines) {
        if (a >= b || share_vertex(a, b) || pairs.count({a, b}) > 0) continue;
        if (gap(boxes[a], boxes[b]) < _options.maximum && (is_faced(a, b) || is_faced(b, a)))
          pairs.insert({a, b}), pairs.insert({b, a});
      }
    }
  }

  static double gap(const geometry::Box& a, const geometry::Box& b) {
    Vec3 apart;
    for (int axis = 0; axis < 3; ++axis) {
      apart[axis] = std::max({a.low[axis] - b.high[axis], b.low[axis] - a.high[axis], 0.0});
    }
    return norm(apart);
  }

  /// Whether the face is between the node of one line that is nearest to the other, and the other.
  bool is_faced(int from, int to) const {
    const auto& nodes = _facets.boundary[to].nodes;
    double least = _options.maximum;
    geometry::Vec2 middle;
    for (const std::int32_t node : _facets.boundary[from].nodes) {
      const Vec3 p = _facets.points[node];
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const Vec3 a = _facets.points[nodes[i]], b = _facets.points[nodes[i + 1]];
        const double t = part_along(p, a, b), away = distance(p, a + t * (b - a));
        if (away >= least) continue;
        least = away;
        const geometry::Vec2 foot = (1 - t) * _facets.uv[nodes[i]] + t * _facets.uv[nodes[i + 1]];
        middle = 0.5 * (_facets.uv[node] + foot);
      }
    }
    return least < _options.maximum && lies_inside(middle);
  }

  /// Whether some facet holds the parameters.
  bool lies_inside(geometry::Vec2 uv) const {
    const auto side = [&](geometry::Vec2 a, geometry::Vec2 b) { return cross(b - a, uv - a); };
    for (const auto& t : _facets.triangles) {
      const geometry::Vec2 a = _facets.uv[t[0]], b = _facets.uv[t[1]], c = _facets.uv[t[2]];
      const double first = side(a, b), second = side(b, c), third = side(c, a);
      if (std::min({first, second, third}) >= 0 || std::max({first, second, third}) <= 0) return true;
    }
    return false;
  }

  bool share_vertex(int a, int b) const {
    const auto& edge_a = _model.edge(_facets.boundary[a].use.edge);
    const auto& edge_b = _model.edge(_facets.boundary[b].use.edge);
    return edge_a.first == edge_b.first || edge_a.first == edge_b.last || edge_a.last == edge_b.first ||
           edge_a.last == edge_b.last;
  }

  double width(Vec3 p, int line) const {
    const auto& nodes = _facets.boundary[line].nodes;
    double nearest = _options.maximum;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      nearest =
          std::min(nearest, distance_to_segment(p, _facets.points[nodes[i]], _facets.points[nodes[i + 1]]));
    }
    return nearest;
  }

  double size_of(double width) const { return std::max(width, smallest_feature_size(_options)); }

  void cover(Vec3 a, double width_a, Vec3 b, double width_b, int line, int depth) {
    const double length = distance(a, b);
    // Widths change no faster than the place: on the whole segment they are at least this.
    const double least = 0.5 * (width_a + width_b - length);
    if (least >= _options.maximum || depth >= deepest_bisection) return;
    if (length <= size_of(std::min(width_a, width_b))) {
      add(a, width_a);
      add(b, width_b);
      return;
    }
    const Vec3 middle = 0.5 * (a + b);
    const double width_middle = width(middle, line);
    cover(a, width_a, middle, width_middle, line, depth + 1);
    cover(middle, width_middle, b, width_b, line, depth + 1);
  }

  void add(Vec3 point, double width) {
    if (width < _options.maximum) _sources.push_back({point, size_of(width)});
  }

  const cad::Model& _model;
  const Facets& _facets;
  const SizingOptions& _options;
  std::vector<SizeSource> _sources;
};

}  // namespace

std::vector<SizeSource> strip_sources(const cad::Model& model, const Facets& facets,
                                      const SizingOptions& options) {
  return Strips(model, facets, options).run();
}

}  // namespace aeroloom::sizing
