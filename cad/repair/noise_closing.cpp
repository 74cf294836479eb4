#include "cad/repair/noise_closing.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/edge_on_face.hpp"
#include "cad/repair/edge_pieces.hpp"
#include "cad/repair/sampled_edge.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// In tolerances: how far apart vertices unite (noise faces lie side by side), pieces do, are looked for.
constexpr double widest_union = 3, beside = 1.5, looked_for = 2;
constexpr double holding = 1.01;  // a vertex's ball over the distance of the ends that it is to hold

/// Plans the closing; numbers of vertices, edges and faces are those of the shape's maps, from 0.
class NoiseClosing {
public:
  NoiseClosing(const TopoDS_Shape& shape, const NoiseItems& items, double tolerance)
      : _items(items), _tolerance(tolerance) {
    TopExp::MapShapes(shape, TopAbs_VERTEX, _vertices);
    TopExp::MapShapes(shape, TopAbs_EDGE, _edges);
    TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, _users);
  }

  Substitution run() {
    number_vertices();
    collapse_edges();
    meet_sides();
    cut_edges();
    classify();
    make_edges();
    Substitution result;
    for (int e = 0; e < _edges.Extent(); ++e) {
      if (!is_touched(e)) continue;
      result.edges.Add(_edges(e + 1).Oriented(TopAbs_FORWARD));
      result.chains.push_back(chain_of(e));
    }
    for (int f = 1; f <= _items.faces.Extent(); ++f) result.removed_faces.Add(_items.faces(f));
    return result;
  }

private:
  [[noreturn]] static void refuse(Vec3 at, const char* why) {
    throw CadError(fmt::format("{} at {}", why, place_in_file(at)));
  }

  TopoDS_Edge edge(int e) const { return TopoDS::Edge(_edges(e + 1).Oriented(TopAbs_FORWARD)); }
  bool is_degenerate(int e) const { return BRep_Tool::Degenerated(edge(e)); }

  const SampledEdge& samples(int e) {
    if (!_samples[e]) _samples[e].emplace(edge(e));
    return *_samples[e];
  }

  void number_vertices() {
    _samples.resize(_edges.Extent());
    _cuts.resize(_edges.Extent());
    for (int v = 1; v <= _vertices.Extent(); ++v)
      _united.add(to_vec(BRep_Tool::Pnt(TopoDS::Vertex(_vertices(v)))));
    for (int e = 0; e < _edges.Extent(); ++e) {
      TopoDS_Vertex first, last;
      TopExp::Vertices(edge(e), first, last);
      if (first.IsNull() || last.IsNull()) throw CadError("an edge has no end vertices");
      _ends.emplace_back(_vertices.FindIndex(first) - 1, _vertices.FindIndex(last) - 1);
    }
  }

  void collapse_edges() {
    std::vector<int> shorts;
    for (int i = 1; i <= _items.edges.Extent(); ++i) shorts.push_back(_edges.FindIndex(_items.edges(i)) - 1);
    std::ranges::sort(shorts, [&](int a, int b) {
      return std::pair(samples(a).length(), a) < std::pair(samples(b).length(), b);
    });
    for (const int e : shorts) _united.unite(_ends[e].first, _ends[e].second, widest_union * _tolerance);
  }

  std::vector<int> edges_of(const TopoDS_Shape& face) const {
    const TopTools_IndexedMapOfShape own = map_of(face, TopAbs_EDGE);
    std::vector<int> edges;
    for (int i = 1; i <= own.Extent(); ++i) {
      const int e = _edges.FindIndex(own(i)) - 1;
      if (!is_degenerate(e)) edges.push_back(e);
    }
    return edges;
  }

  bool is_at(int e, int root) const {
    if (_united.root(_ends[e].first) == root || _united.root(_ends[e].second) == root) return true;
    return std::ranges::any_of(_cuts[e],
                               [&](const EdgeCut& cut) { return _united.root(cut.vertex) == root; });
  }

  /// Every vertex of a noise face is joined with what is opposite.
  void meet_sides() {
    std::deque<std::pair<int, int>> wanted;  // of noise faces' and vertices' numbers
    for (int f = 0; f < _items.faces.Extent(); ++f) {
      _noise_edges.push_back(edges_of(_items.faces(f + 1)));
      std::set<int> own;
      for (const int e : _noise_edges.back()) own.insert({_ends[e].first, _ends[e].second});
      for (const int v : own) wanted.emplace_back(f, v);
    }
    while (!wanted.empty()) {
      const auto [f, v] = wanted.front();
      wanted.pop_front();
      for (const int e : _noise_edges[f]) {
        if (is_at(e, _united.root(v)) || is_short(e)) continue;
        const SampledEdge::Foot foot = samples(e).nearest(_united.place(v), _tolerance);
        if (foot.away > _tolerance || !meet(v, e, foot.parameter)) continue;
        // Other noise faces along that edge have to follow.
        for (int other = 0; other < _items.faces.Extent(); ++other) {
          const auto& edges = _noise_edges[other];
          if (other != f && std::ranges::find(edges, e) != edges.end())
            wanted.emplace_back(other, _cuts[e].back().vertex);
        }
      }
    }
  }

  bool is_short(int e) { return samples(e).length() <= _tolerance; }

  /// Joins a vertex with a place on an edge. True when the edge is cut there.
  bool meet(int v, int e, double parameter) {
    const Vec3 at = samples(e).point(parameter);
    const double near = 2 * _tolerance;
    for (const int end : {_ends[e].first, _ends[e].second}) {
      if (distance(_united.place(end), at) <= near && _united.unite(v, end, widest_union * _tolerance))
        return false;
    }
    for (const EdgeCut& cut : _cuts[e]) {
      if (distance(_united.place(cut.vertex), at) <= near &&
          _united.unite(v, cut.vertex, widest_union * _tolerance))
        return false;
    }
    const int made = _united.add(at);
    if (!_united.unite(v, made, widest_union * _tolerance)) refuse(at, "too many vertices would become one");
    _cuts[e].push_back({parameter, made});
    return true;
  }

  void cut_edges() {
    _pieces_of.resize(_edges.Extent());
    for (int e = 0; e < _edges.Extent(); ++e) {
      if (is_degenerate(e)) {
        double first, last;
        BRep_Tool::Range(edge(e), first, last);
        add_piece({e, first, last, _united.root(_ends[e].first), _united.root(_ends[e].second)});
        continue;
      }
      auto& cuts = _cuts[e];
      std::ranges::sort(cuts, [](const EdgeCut& a, const EdgeCut& b) { return a.parameter < b.parameter; });
      if (!cuts.empty()) BRepLib::SameRange(edge(e));
      double first, last;
      BRep_Tool::Range(edge(e), first, last);
      double from = first;
      int start = _ends[e].first;
      for (const EdgeCut& cut : cuts) {
        add_piece({e, from, cut.parameter, _united.root(start), _united.root(cut.vertex)});
        from = cut.parameter, start = cut.vertex;
      }
      add_piece({e, from, last, _united.root(start), _united.root(_ends[e].second)});
    }
  }

  void add_piece(EdgePiece piece) {
    if (!is_degenerate(piece.edge) && (piece.start == piece.end || !_cuts[piece.edge].empty()))
      piece.length = rough_length_of(piece);
    piece.like = static_cast<int>(_pieces.size());
    _pieces_of[piece.edge].push_back(piece.like);
    _pieces.push_back(std::move(piece));
  }

  double rough_length_of(const EdgePiece& piece) {
    constexpr int steps = 16;  // rough: compared with some tolerances alone
    const SampledEdge& curve = samples(piece.edge);
    double length = 0;
    for (int i = 0; i < steps; ++i) {
      const auto at = [&](int k) {
        return curve.point(piece.first + (piece.last - piece.first) * k / steps);
      };
      length += distance(at(i), at(i + 1));
    }
    return length;
  }

  /// A piece that becomes a vertex: its ends did, and it does not lead far from it. A closed edge of the
  /// shape is not one unless it is to be closed.
  bool is_collapsed(const EdgePiece& piece) const {
    if (piece.start != piece.end || is_degenerate(piece.edge)) return false;
    if (piece.length > (widest_union + 1) * _tolerance) return false;
    return _ends[piece.edge].first != _ends[piece.edge].second || _items.edges.Contains(edge(piece.edge));
  }

  Vec3 middle_of(const EdgePiece& of) { return samples(of.edge).point(0.5 * (of.first + of.last)); }

  /// Whether one runs beside the other all along.
  bool are_beside(const EdgePiece& a, const EdgePiece& b) {
    const bool alike = std::minmax(a.start, a.end) == std::minmax(b.start, b.end);
    if (!alike) return false;
    for (const double fraction : {0.5, 0.25, 0.75}) {
      const Vec3 at = samples(a.edge).point(a.first + fraction * (a.last - a.first));
      if (samples(b.edge).nearest(at, looked_for * _tolerance).away > beside * _tolerance) return false;
    }
    return true;
  }

  bool run_against(const EdgePiece& a, const EdgePiece& b) {
    if (a.start != a.end) return a.start == b.end;
    const Vec3 at = middle_of(a);
    const SampledEdge::Foot foot = samples(b.edge).nearest(at, looked_for * _tolerance);
    return dot(samples(a.edge).tangent(0.5 * (a.first + a.last)), samples(b.edge).tangent(foot.parameter)) <
           0;
  }

  int like(int p) const {
    while (_pieces[p].like != p) p = _pieces[p].like;
    return p;
  }

  /// Which pieces become one: each side of a noise face with the other.
  void classify() {
    for (int f = 0; f < _items.faces.Extent(); ++f) {
      std::vector<int> own;
      for (const int e : _noise_edges[f]) {
        for (const int p : _pieces_of[e]) {
          if (!is_collapsed(_pieces[p])) own.push_back(p);
        }
      }
      for (const int p : own) {
        bool paired = false;
        for (const int q : own) {
          if (q == p || !are_beside(_pieces[p], _pieces[q])) continue;
          paired = true;
          const int a = like(p), b = like(q);
          if (a != b) _pieces[std::max(a, b)].like = std::min(a, b);
        }
        if (!paired) refuse(middle_of(_pieces[p]), "two sides do not meet along their whole length");
      }
    }
    choose_leaders();
  }

  /// The piece that stays is chosen by its place alone, so that two solids which touch in copies of a strip
  /// choose alike.
  void choose_leaders() {
    const Vec3 direction{0.5377, 0.6231, 0.5681};  // askew: symmetric pieces are not equally far along it
    std::vector<int> leader(_pieces.size(), -1);
    for (int p = 0; p < static_cast<int>(_pieces.size()); ++p) {
      const int root = like(p);
      if (root == p && leader[root] < 0) leader[root] = p;
      if (root == p) continue;
      if (dot(middle_of(_pieces[p]), direction) < dot(middle_of(_pieces[leader[root]]), direction))
        leader[root] = p;
    }
    std::vector<int> now(_pieces.size());
    for (int p = 0; p < static_cast<int>(_pieces.size()); ++p) now[p] = leader[like(p)];
    for (int p = 0; p < static_cast<int>(_pieces.size()); ++p) {
      _pieces[p].like = now[p];
      if (now[p] != p) _pieces[p].against = run_against(_pieces[p], _pieces[now[p]]);
      if (now[p] != p) _is_shared.insert(now[p]);
    }
  }

  bool is_touched(int e) const {
    if (_pieces_of[e].size() != 1) return true;
    const EdgePiece& piece = _pieces[_pieces_of[e].front()];
    return piece.like != _pieces_of[e].front() || _is_shared.contains(piece.like) || is_collapsed(piece) ||
           is_moved(_ends[e].first) || is_moved(_ends[e].second);
  }
  bool is_moved(int v) const { return _moved_roots.contains(_united.root(v)); }

  TopoDS_Vertex vertex(int root) {
    auto& made = _made_vertices[root];
    if (!made.IsNull()) return made;
    if (!_moved_roots.contains(root)) {
      made = TopoDS::Vertex(_vertices(root + 1).Oriented(TopAbs_FORWARD));
      return made;
    }
    const auto [at, radius] = _united.middle(root);
    double tolerance = Precision::Confusion();
    for (int v = 0; v < _vertices.Extent(); ++v) {
      if (_united.root(v) == root)
        tolerance = std::max(tolerance, BRep_Tool::Tolerance(TopoDS::Vertex(_vertices(v + 1))));
    }
    BRep_Builder().MakeVertex(made, gp_Pnt(at.x, at.y, at.z), holding * radius + tolerance);
    return made;
  }

  void make_edges() {
    std::map<int, int> members;
    for (int v = 0; v < _united.count(); ++v) ++members[_united.root(v)];
    for (const auto& [root, count] : members) {
      if (count > 1) _moved_roots.insert(root);
    }
    _made_vertices.resize(_united.count());
    for (int e = 0; e < _edges.Extent(); ++e) {
      if (!is_touched(e)) continue;
      for (const int p : _pieces_of[e]) {
        if (_pieces[p].like == p && !is_collapsed(_pieces[p])) make_edge(_pieces[p]);
      }
    }
    for (int p = 0; p < static_cast<int>(_pieces.size()); ++p) {
      if (_pieces[p].like != p && !is_collapsed(_pieces[p]))
        give_images(_pieces[p], _pieces[_pieces[p].like]);
    }
  }

  void make_edge(EdgePiece& piece) {
    BRep_Builder builder;
    piece.made = TopoDS::Edge(edge(piece.edge).EmptyCopied());
    if (_pieces_of[piece.edge].size() > 1) builder.Range(piece.made, piece.first, piece.last);
    builder.Add(piece.made, vertex(piece.start).Oriented(TopAbs_FORWARD));
    builder.Add(piece.made, vertex(piece.end).Oriented(TopAbs_REVERSED));
  }

  /// The faces that lose a piece see the one that takes its place.
  void give_images(const EdgePiece& lost, EdgePiece& taken) {
    BRep_Builder builder;
    const EdgeInterval own{edge(taken.edge), taken.first, taken.last},
        other{edge(lost.edge), lost.first, lost.last};
    for (const TopoDS_Shape& user : _users.FindFromKey(_edges(lost.edge + 1))) {
      if (_items.faces.Contains(user)) continue;
      const TopoDS_Face face = TopoDS::Face(user.Oriented(TopAbs_FORWARD));
      if (BRep_Tool::IsClosed(edge(lost.edge), face)) refuse(middle_of(lost), "a seam beside a strip");
      double first, last;
      const Handle(Geom2d_Curve) image = BRep_Tool::CurveOnSurface(edge(lost.edge), face, first, last);
      if (image.IsNull()) refuse(middle_of(lost), "an edge beside a strip has no parameter curve");
      const Handle(Geom2d_Curve) now = image_beside(own, other, image, lost.against, _tolerance);
      add_image(taken.made, now, face, is_passed_forward(lost.edge, face) != lost.against,
                beside * _tolerance);
      builder.Range(taken.made, face, taken.first, taken.last);
    }
    builder.SameRange(taken.made, true);
    builder.SameParameter(taken.made, true);
    for (const int root : {taken.start, taken.end}) builder.UpdateVertex(vertex(root), beside * _tolerance);
  }

  bool is_passed_forward(int e, const TopoDS_Face& face) const {
    for (TopExp_Explorer each(face, TopAbs_EDGE); each.More(); each.Next()) {
      if (each.Current().IsSame(_edges(e + 1))) return each.Current().Orientation() == TopAbs_FORWARD;
    }
    return true;
  }

  EdgeChain chain_of(int e) const {
    EdgeChain chain;
    for (const int p : _pieces_of[e]) {
      const EdgePiece& piece = _pieces[p];
      if (is_collapsed(piece)) continue;
      const TopoDS_Edge& made = _pieces[piece.like].made;
      chain.push_back(TopoDS::Edge(made.Oriented(piece.against ? TopAbs_REVERSED : TopAbs_FORWARD)));
    }
    return chain;
  }

  const NoiseItems& _items;
  double _tolerance;
  TopTools_IndexedMapOfShape _vertices, _edges;
  TopTools_IndexedDataMapOfShapeListOfShape _users;
  std::vector<std::pair<int, int>> _ends;  // vertices of edges
  std::vector<std::optional<SampledEdge>> _samples;
  UnitedVertices _united;
  std::vector<std::vector<EdgeCut>> _cuts;     // by edge
  std::vector<std::vector<int>> _noise_edges;  // by noise face
  std::vector<EdgePiece> _pieces;
  std::vector<std::vector<int>> _pieces_of;  // by edge
  std::set<int> _is_shared;                  // pieces that take others' places
  std::set<int> _moved_roots;
  std::vector<TopoDS_Vertex> _made_vertices;
};

}  // namespace

Substitution plan_closing(const TopoDS_Shape& shape, const NoiseItems& items, double tolerance) {
  return NoiseClosing(shape, items, tolerance).run();
}

}  // namespace aeroloom::cad
