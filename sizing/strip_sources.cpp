// Narrow faces: where two edges of a face come closer than its elements are large.
#include "sizing/closed_corners.hpp"
#include "sizing/curvature_size.hpp"
#include "sizing/model_sources.hpp"
#include "sizing/segment_tree.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::Facets;
using geometry::Vec3;

constexpr int facets_per_leaf = 8;

/// The boundary lines of one face, which of them lie opposite each other, and how far apart.
class Strips {
public:
  /// Widths from `reach` on do not matter.
  Strips(const cad::Model& model, const Facets& facets, std::span<const EdgePair> closed_corners,
         const SizingOptions& options, double reach)
      : _model(model), _facets(facets), _closed_corners(closed_corners), _options(options), _reach(reach) {}

  std::vector<StripPart> run() {
    list_lines();
    if (_lines.size() < 2) return {};
    join_lines();
    for (const int line : _lines) cover_line(line);
    if (!_closed_corners.empty()) {
      _beside_corners = true;
      for (const int line : _lines) cover_line(line);
    }
    return std::move(_parts);
  }

private:
  void cover_line(int line) {
    const auto& nodes = _facets.boundary[line].nodes;
    double width_a = width(_facets.points[nodes.front()], line, _reach);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const Vec3 a = _facets.points[nodes[i]], b = _facets.points[nodes[i + 1]];
      const double width_b = width(b, line, width_a + distance(a, b));
      cover(a, width_a, b, width_b, line, 0);
      width_a = width_b;
    }
  }

  /// Those that carry elements, and their segments.
  void list_lines() {
    std::vector<SegmentTree::Segment> segments;
    for (std::size_t line = 0; line < _facets.boundary.size(); ++line) {
      const auto& nodes = _facets.boundary[line].nodes;
      if (nodes.size() < 2 || _model.is_seam(_facets.boundary[line].use.edge)) continue;
      _lines.push_back(static_cast<int>(line));
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        segments.push_back(
            {_facets.points[nodes[i]], _facets.points[nodes[i + 1]], static_cast<std::int32_t>(line)});
      }
    }
    _segments = SegmentTree(std::move(segments));
  }

  /// Lines that some facet joins, or the facets around a point inside, face each other.
  void join_lines() {
    std::vector<std::vector<int>> lines_of(_facets.points.size());
    for (const int line : _lines) {
      for (const std::int32_t node : _facets.boundary[line].nodes) lines_of[node].push_back(line);
    }
    const auto join = [&](const auto& first, const auto& second) {
      for (const int a : first) {
        for (const int b : second) {
          if (a != b) _facing[std::minmax(a, b)] = true;
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
  }

  /// Whether two lines lie opposite each other: those without a common vertex or, beside corners that are
  /// closed, those that end in one. Where the short end of a strip has
  /// nodes of its own, no facet joins the long sides: they are facing if facets lie between the places where
  /// they are nearest. Asked for lines that are near, and remembered.
  bool are_facing(int a, int b) {
    if (a == b) return false;
    if (share_vertex(a, b)) return _beside_corners && end_in_closed_corner(a, b);
    if (_beside_corners) return false;
    const auto [known, is_new] = _facing.try_emplace(std::minmax(a, b), false);
    if (is_new) known->second = is_faced(a, b) || is_faced(b, a);
    return known->second;
  }

  /// Whether the face is between the node of one line that is nearest to the other, and the other.
  bool is_faced(int from, int to) {
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
  bool lies_inside(geometry::Vec2 uv) {
    if (_plane.nodes().empty()) {
      std::vector<geometry::Box> boxes(_facets.triangles.size());
      for (std::size_t t = 0; t < boxes.size(); ++t) {
        for (const std::int32_t node : _facets.triangles[t])
          boxes[t].add(Vec3{_facets.uv[node].x, _facets.uv[node].y, 0});
      }
      _plane = geometry::BoxTree(boxes, facets_per_leaf);
    }
    const auto side = [&](geometry::Vec2 a, geometry::Vec2 b) { return cross(b - a, uv - a); };
    bool inside = false;
    _plane.search(
        [&](const geometry::Box& box) {
          return !inside && uv.x >= box.low.x && uv.x <= box.high.x && uv.y >= box.low.y &&
                 uv.y <= box.high.y;
        },
        [&](std::int32_t place) {
          const auto& t = _facets.triangles[_plane.order()[place]];
          const geometry::Vec2 a = _facets.uv[t[0]], b = _facets.uv[t[1]], c = _facets.uv[t[2]];
          const double first = side(a, b), second = side(b, c), third = side(c, a);
          inside = inside || std::min({first, second, third}) >= 0 || std::max({first, second, third}) <= 0;
        });
    return inside;
  }

  bool end_in_closed_corner(int a, int b) const {
    const EdgePair edges = std::minmax(_facets.boundary[a].use.edge, _facets.boundary[b].use.edge);
    return std::find(_closed_corners.begin(), _closed_corners.end(), edges) != _closed_corners.end();
  }

  bool share_vertex(int a, int b) const {
    const auto& edge_a = _model.edge(_facets.boundary[a].use.edge);
    const auto& edge_b = _model.edge(_facets.boundary[b].use.edge);
    return edge_a.first == edge_b.first || edge_a.first == edge_b.last || edge_a.last == edge_b.first ||
           edge_a.last == edge_b.last;
  }

  /// The distance to the nearest line that faces this one; `bound` where none is nearer. Widths change no
  /// faster than the place: a width near by gives a bound.
  double width(Vec3 p, int line, double bound) {
    return _segments.nearest(p, std::min(bound, _reach), [&](int other) { return are_facing(line, other); });
  }

  double size_of(double width) const { return std::max(width, smallest_strip_size(_options)); }

  void cover(Vec3 a, double width_a, Vec3 b, double width_b, int line, int depth) {
    const double length = distance(a, b);
    // Widths change no faster than the place: on the whole segment they are at least this.
    const double least = 0.5 * (width_a + width_b - length);
    if (least >= _reach || depth >= deepest_bisection) return;
    if (_beside_corners && 0.5 * (width_a + width_b + length) < closing_gap(_options)) return;
    if (length <= size_of(std::min(width_a, width_b))) {
      _parts.push_back({a, b, open_width(width_a), open_width(width_b)});
      return;
    }
    const Vec3 middle = 0.5 * (a + b);
    const double width_middle = width(middle, line, std::min(width_a, width_b) + 0.5 * length);
    cover(a, width_a, middle, width_middle, line, depth + 1);
    cover(middle, width_middle, b, width_b, line, depth + 1);
  }

  /// A corner asks for nothing as far as it is closed.
  double open_width(double width) const {
    return _beside_corners && width < closing_gap(_options) ? _reach : width;
  }

  const cad::Model& _model;
  const Facets& _facets;
  std::span<const EdgePair> _closed_corners;
  const SizingOptions& _options;
  double _reach;
  std::vector<int> _lines;
  SegmentTree _segments;                        // by line
  std::map<std::pair<int, int>, bool> _facing;  // of those asked for, the lower line first
  bool _beside_corners = false;                 // edges that share a vertex are looked at, and no others
  geometry::BoxTree _plane;                     // of the facets' parameters, when it is asked for
  std::vector<StripPart> _parts;
};

}  // namespace

std::vector<StripPart> strip_parts(const cad::Model& model, const Facets& facets,
                                   std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                   double reach) {
  return Strips(model, facets, closed_corners, options, reach).run();
}

std::vector<SizeSource> strip_sources(const cad::Model& model, const Facets& facets,
                                      std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                      double reach) {
  std::vector<SizeSource> sources;
  for (const StripPart& part : strip_parts(model, facets, closed_corners, options, reach)) {
    for (const auto& [point, width] :
         {std::pair(part.first, part.first_width), std::pair(part.last, part.last_width)}) {
      if (width < reach) sources.push_back({point, std::max(width, smallest_strip_size(options))});
    }
  }
  return sources;
}

}  // namespace aeroloom::sizing
