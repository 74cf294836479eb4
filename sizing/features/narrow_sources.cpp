// Narrow faces: where two edges of a face come closer than its elements are large.
#include "cad/model/evaluation/point_locator.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/segment_tree.hpp"
#include "sizing/field/closed_corners.hpp"
#include "sizing/field/curvature_size.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::Facets;
using geometry::Vec3;

constexpr int facets_per_leaf = 8;  // chosen, not measured
/// Of a width: what segments may leave their curves by before the curves themselves are asked.
constexpr double width_error = 0.01;
/// Two places of one line lie opposite each other where the way along it is more than so many times the
/// distance: a half circle is 1.6 times as long as wide. Chosen, not measured.
constexpr double least_way = 4;
/// Closed lines whose ends turn by more than 60 degrees have a corner there. Chosen, not measured.
constexpr double smooth_cosine = 0.5;

/// The boundary lines of one face, which of them lie opposite each other, and how far apart: nearest
/// distances between curves, for segments of facets may leave them by more than that.
class NarrowRegions {
public:
  /// Widths from `reach` on do not matter.
  NarrowRegions(const cad::Model& model, const Facets& facets, std::span<const EdgePair> closed_corners,
                const SizingOptions& options, double reach)
      : _model(model), _facets(facets), _closed_corners(closed_corners), _options(options), _reach(reach) {}

  std::vector<NarrowSegment> run() {
    list_lines();
    join_lines();
    look_inwards();
    for (const int line : _lines) cover_line(line);
    if (!_closed_corners.empty()) {
      _beside_corners = true;
      for (const int line : _lines) cover_line(line);
    }
    return std::move(_parts);
  }

private:
  /// A segment of a line.
  struct Piece {
    int line;
    std::size_t node;  ///< the first
    double sag;        ///< its distance from the curve, about
    double way;        ///< along the line, to its first node
    Vec3 inwards;      ///< into the face from its second node, about
  };
  /// A place on a line.
  struct Station {
    Vec3 point;
    double parameter, way, width;
  };

  void cover_line(int line) {
    const auto& [use, nodes, parameters] = _facets.boundary[line];
    const std::size_t first = _first_piece[line];
    Station a{_facets.points[nodes[0]], parameters[0], 0, 0};
    a.width = width(a, first, _reach);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double length = distance(a.point, _facets.points[nodes[i + 1]]);
      Station b{_facets.points[nodes[i + 1]], parameters[i + 1], a.way + length, 0};
      b.width = width(b, first + i, a.width + length);
      cover(a, b, first + i, 0);
      a = b;
    }
  }

  /// Lists boundary lines that carry elements, and their segments.
  void list_lines() {
    std::vector<SegmentTree::Segment> segments;
    _first_piece.resize(_facets.boundary.size());
    _lengths.resize(_facets.boundary.size());
    for (std::size_t line = 0; line < _facets.boundary.size(); ++line) {
      const auto& [use, nodes, parameters] = _facets.boundary[line];
      if (nodes.size() < 2 || _model.is_seam(use.edge)) continue;
      _lines.push_back(static_cast<int>(line));
      _first_piece[line] = _pieces.size();
      double way = 0;
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const Vec3 a = _facets.points[nodes[i]], b = _facets.points[nodes[i + 1]];
        const Vec3 middle = _model.edge_point(use.edge, 0.5 * (parameters[i] + parameters[i + 1]));
        const double sag = distance_to_segment(middle, a, b);
        segments.push_back({a, b, static_cast<std::int32_t>(_pieces.size())});
        _pieces.push_back({static_cast<int>(line), i, sag, way, {}});
        _largest_sag = std::max(_largest_sag, sag);
        way += distance(a, b);
      }
      _lengths[line] = way;
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

  /// Finds the facet on each segment.
  void look_inwards() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> piece_of;
    for (std::size_t i = 0; i < _pieces.size(); ++i) {
      const auto& nodes = _facets.boundary[_pieces[i].line].nodes;
      piece_of[std::minmax(nodes[_pieces[i].node], nodes[_pieces[i].node + 1])] = i;
    }
    for (const auto& t : _facets.triangles) {
      for (int i = 0; i < 3; ++i) {
        const auto found = piece_of.find(std::minmax(t[i], t[(i + 1) % 3]));
        if (found == piece_of.end()) continue;
        const Vec3 a = _facets.points[t[i]], side = _facets.points[t[(i + 1) % 3]] - a;
        const Vec3 in = _facets.points[t[(i + 2) % 3]] - a;
        const double square = dot(side, side);
        _pieces[found->second].inwards = square > 0 ? in - dot(in, side) / square * side : in;
      }
    }
  }

  /// Whether a place on a segment faces another segment of the same line over the face, where the line goes
  /// to and fro: a blunt trailing edge with a round end. The way between them must not lead over a
  /// corner.
  bool faces_itself(const Station& place, const Piece& own, const Piece& other) const {
    if (_beside_corners || (own.node <= other.node + 1 && other.node <= own.node + 1)) return false;
    const auto& nodes = _facets.boundary[other.line].nodes;
    const Vec3 a = _facets.points[nodes[other.node]], b = _facets.points[nodes[other.node + 1]];
    const double part = part_along(place.point, a, b);
    const Vec3 over = a + part * (b - a) - place.point;
    double way = std::abs(other.way + part * distance(a, b) - place.way);
    const cad::EdgeId edge = _facets.boundary[other.line].use.edge;
    const double over_ends =
        _lengths[other.line] - way + distance(_facets.points[nodes.front()], _facets.points[nodes.back()]);
    if (over_ends < way && _model.edge(edge).first == _model.edge(edge).last && turns_at_ends(edge))
      return false;
    way = std::min(way, over_ends);
    return way > least_way * (norm(over) + own.sag + other.sag) && dot(over, own.inwards) > 0;
  }

  /// Whether a closed edge has a corner where it begins.
  bool turns_at_ends(cad::EdgeId id) const {
    const cad::Edge& edge = _model.edge(id);
    const Vec3 first = _model.edge_tangent(id, edge.first_parameter);
    const Vec3 last = _model.edge_tangent(id, edge.last_parameter);
    return dot(first, last) < smooth_cosine * norm(first) * norm(last);
  }

  /// Whether two lines lie opposite each other: those without a common vertex or, beside corners that are
  /// closed, those that end in one. Where the short end of a narrow region has
  /// nodes of its own, no facet joins the long sides: they are facing if facets lie between the places where
  /// they are nearest. Asked for lines that are near, and remembered.
  bool are_facing(int a, int b) {
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

  /// The distance to the nearest line that faces this one, or part of this one; `bound` where none is nearer.
  /// Widths change no faster than the place: a width near by gives a bound.
  double width(const Station& place, std::size_t on, double bound) {
    bound = std::min(bound, _reach);
    const Vec3 p = place.point;
    const Piece& own = _pieces[on];
    const SegmentTree::Hit hit = _segments.nearest_hit(p, bound + _largest_sag, [&](std::int32_t piece) {
      const Piece& other = _pieces[piece];
      return other.line == own.line ? faces_itself(place, own, other) : are_facing(own.line, other.line);
    });
    if (hit.tag < 0) return bound;
    const Piece& piece = _pieces[hit.tag];
    if (piece.sag <= width_error * hit.away) return std::min(bound, hit.away);
    const auto& [use, nodes, parameters] = _facets.boundary[piece.line];
    const double fraction =
        part_along(p, _facets.points[nodes[piece.node]], _facets.points[nodes[piece.node + 1]]);
    const double guess = (1 - fraction) * parameters[piece.node] + fraction * parameters[piece.node + 1];
    return std::min(bound, cad::foot_on_edge(_model, use.edge, p, guess).away);
  }

  void cover(const Station& a, const Station& b, std::size_t on, int depth) {
    const double length = distance(a.point, b.point);
    // Widths change no faster than the place: on the whole segment they are at least this.
    const double least = 0.5 * (a.width + b.width - length);
    if (least >= _reach || depth >= deepest_bisection) return;
    if (_beside_corners && 0.5 * (a.width + b.width + length) < closing_gap(_options)) return;
    const double narrower = std::min(a.width, b.width);
    if (length <= narrow_size(narrower, _options)) {
      _parts.push_back({a.point, b.point, open_width(a.width), open_width(b.width)});
      return;
    }
    Station middle{0.5 * (a.point + b.point), 0.5 * (a.parameter + b.parameter), 0.5 * (a.way + b.way), 0};
    if (_pieces[on].sag > width_error * narrower)
      middle.point = _model.edge_point(_facets.boundary[_pieces[on].line].use.edge, middle.parameter);
    middle.width = width(middle, on, narrower + 0.5 * length);
    cover(a, middle, on, depth + 1);
    cover(middle, b, on, depth + 1);
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
  std::vector<double> _lengths;           // by line
  std::vector<Piece> _pieces;             // of the lines, one after the other
  std::vector<std::size_t> _first_piece;  // by line
  double _largest_sag = 0;
  SegmentTree _segments;                        // by piece
  std::map<std::pair<int, int>, bool> _facing;  // of those asked for, the lower line first
  bool _beside_corners = false;                 // edges that share a vertex are looked at, and no others
  geometry::BoxTree _plane;                     // of the facets' parameters, when it is asked for
  std::vector<NarrowSegment> _parts;
};

}  // namespace

std::vector<NarrowSegment> narrow_segments(const cad::Model& model, const Facets& facets,
                                           std::span<const EdgePair> closed_corners,
                                           const SizingOptions& options, double reach) {
  return NarrowRegions(model, facets, closed_corners, options, reach).run();
}

std::vector<SizeSource> narrow_sources(const cad::Model& model, const Facets& facets,
                                       std::span<const EdgePair> closed_corners, const SizingOptions& options,
                                       double reach) {
  std::vector<SizeSource> sources;
  for (const NarrowSegment& part : narrow_segments(model, facets, closed_corners, options, reach)) {
    for (const auto& [point, width] :
         {std::pair(part.first, part.first_width), std::pair(part.last, part.last_width)}) {
      if (width < reach) sources.push_back({point, narrow_size(width, options)});
    }
  }
  return sources;
}

}  // namespace aeroloom::sizing
