#include "cad/model/evaluation/face_cache.hpp"
#include "cad/model/evaluation/face_corners.hpp"
#include "cad/model/evaluation/face_width.hpp"
#include "cad/model/evaluation/plane_snap.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/topology/blunt_edges.hpp"
#include "cad/model/topology/border_path.hpp"
#include "cad/model/topology/closed_edges_data.hpp"
#include "cad/model/topology/middle_curves.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <ranges>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Puts a model together in which strips are closed.
class Closing {
public:
  Closing(const Model& base, std::vector<BluntEdge> strips)
      : _base(base), _strips(std::move(strips)), _closed{base, {}, {}, {}, {}, {}} {}

  Model run() {
    mark_edges();
    for (const BluntEdge& strip : _strips) {
      _paths.push_back({BorderPath(_base, strip.borders[0]), BorderPath(_base, strip.borders[1])});
      _stations.push_back(place_stations(_base, strip, _paths.back()));
    }
    join_vertices();
    _data = std::make_shared<Model::Data>(_base.data());
    keep_faces();
    require_broad_corners();
    keep_edges();
    for (std::size_t i = 0; i < _strips.size(); ++i) add_middles(i);
    rewrite_loops();
    number_vertices();
    mark_planes_again(*_data, _closed.moved);
    std::vector<FaceId> faces;
    for (const BluntEdge& strip : _strips) faces.push_back(strip.face);
    _data->bytes = with_closed_edges(_base.data().bytes, faces);
    _data->closed = std::make_shared<const ClosedEdges>(std::move(_closed));
    return Model(std::move(_data));
  }

private:
  [[noreturn]] void refuse(const BluntEdge& strip, const char* why) const {
    throw CadError(fmt::format("the strip '{}' cannot be closed: {}", _base.face(strip.face).name, why));
  }

  void mark_edges() {
    _closed.fates.resize(_base.edge_count());
    for (const BluntEdge& strip : _strips) {
      for (const auto& end : strip.ends) {
        for (const EdgeId id : end) _closed.fates[id].kind = BaseEdgeFate::Kind::collapsed;
      }
    }
    // Where a strip ends on the side of another, their common edge becomes a vertex of that side.
    for (BluntEdge& strip : _strips) {
      for (auto& border : strip.borders) {
        std::erase_if(border, [&](const BorderEdge& each) {
          return _closed.fates[each.strip_use.edge].kind == BaseEdgeFate::Kind::collapsed;
        });
        if (border.empty()) refuse(strip, "another strip ends on all of its side");
        for (const BorderEdge& each : border) {
          BaseEdgeFate& fate = _closed.fates[each.strip_use.edge];
          if (fate.kind != BaseEdgeFate::Kind::kept) refuse(strip, "a strip beside it is closed");
          fate.kind = BaseEdgeFate::Kind::closed;
        }
      }
    }
  }

  /// Numbers of vertices while they are joined: those of the base model, then stations without a vertex.
  VertexId number_of(const Station& station, VertexId without) const {
    if (station.vertices[0] != no_entity) return station.vertices[0];
    return station.vertices[1] != no_entity ? station.vertices[1] : without;
  }

  void join_vertices() {
    VertexId count = _base.vertex_count();
    for (const auto& stations : _stations) {
      std::vector<VertexId>& numbers = _station_vertices.emplace_back();
      for (const Station& station : stations) {
        numbers.push_back(number_of(station, count));
        if (numbers.back() == count) ++count;
      }
    }
    _roots.emplace(count);
    for (std::size_t i = 0; i < _strips.size(); ++i) {
      for (const Station& station : _stations[i]) {
        if (station.vertices[0] != no_entity && station.vertices[1] != no_entity)
          _roots->unite(station.vertices[0], station.vertices[1]);
      }
      for (const auto& end : _strips[i].ends) {
        for (const EdgeId id : end) _roots->unite(_base.edge(id).first, _base.edge(id).last);
      }
    }
    place_vertices(count);
    for (std::size_t i = 0; i < _strips.size(); ++i) {
      for (std::size_t k = 1; k < _stations[i].size(); ++k) {
        if (root(i, k - 1) == root(i, k)) refuse(_strips[i], "its ends become one vertex");
      }
    }
  }

  VertexId root(std::size_t strip, std::size_t station) {
    return _roots->root(_station_vertices[strip][station]);
  }

  /// A joined vertex lies half-way between the borders; where several strips meet, in the middle of theirs.
  void place_vertices(VertexId count) {
    std::vector<Vec3> sums(count);
    std::vector<int> terms(count, 0);
    for (std::size_t i = 0; i < _strips.size(); ++i) {
      for (std::size_t k = 0; k < _stations[i].size(); ++k) {
        const Station& station = _stations[i][k];
        Vec3 sum;
        for (int side = 0; side < 2; ++side) {
          sum += station.vertices[side] != no_entity ? _base.vertex(station.vertices[side])
                                                     : _paths[i][side].at(station.passed[side]).point;
        }
        sums[root(i, k)] += 0.5 * sum;
        ++terms[root(i, k)];
      }
    }
    _places.resize(count);
    for (VertexId v = 0; v < count; ++v) {
      const VertexId r = _roots->root(v);
      if (terms[r] > 0)
        _places[v] = (1.0 / terms[r]) * sums[r];
      else if (v < _base.vertex_count())
        _places[v] = _base.vertex(v);
    }
  }

  void keep_faces() {
    std::vector<char> closed(_base.face_count(), 0);
    for (const BluntEdge& strip : _strips) closed[strip.face] = 1;
    const Model::Data& from = _base.data();
    Model::Data& to = *_data;
    to.faces.clear(), to.face_evaluators.clear(), to.face_snaps.clear(), to.far_field.clear();
    to.patches.clear();
    for (FaceId id = 0; id < _base.face_count(); ++id) {
      if (closed[id]) continue;
      Face face = from.faces[id];
      face.patch = patch_number(to.patches, from.patches[face.patch]);
      to.faces.push_back(std::move(face));
      to.face_evaluators.push_back(from.face_evaluators[id]);
      to.face_snaps.push_back(from.face_snaps[id]);
      to.far_field.push_back(from.far_field[id]);
      _closed.base_faces.push_back(id);
    }
    to.cache = std::make_shared<FaceCache>(*from.cache, _closed.base_faces);
  }

  /// A face that runs out to a point at a vertex, narrower than the vertex moves, cannot follow it.
  void require_broad_corners() const {
    constexpr double away = 10, narrow = 2;  // in moves of the vertex: corners of a fifth of a radian; chosen
    const auto is_kept = [&](EdgeId id) { return _closed.fates[id].kind == BaseEdgeFate::Kind::kept; };
    for (const FaceId id : _closed.base_faces) {
      for (const FaceCorner& corner : corners_of(_base, id)) {
        const Vec3 at = _base.vertex(corner.vertex);
        const double move = distance(_places[corner.vertex], at);
        if (move == 0 || !is_kept(corner.arriving.edge) || !is_kept(corner.leaving.edge)) continue;
        const auto opening = open_corner(_base, corner, away * move);
        if (!opening || opening->width > narrow * move) continue;
        throw CadError(fmt::format("face '{}' beside it runs out to a point at {}", _base.face(id).name,
                                   place_in_file(at)));
      }
    }
  }

  /// Edges that stay, with joined vertices for ends and drawn to them. Vertices have their joined numbers.
  void keep_edges() {
    const Model::Data& from = _base.data();
    Model::Data& to = *_data;
    to.edges.clear(), to.edge_evaluators.clear(), to.edge_snaps.clear();
    std::vector<char> used(_base.edge_count(), 0);
    for (const FaceId id : _closed.base_faces) {
      for (const Coedge& use : from.faces[id].loops | std::views::join) used[use.edge] = 1;
    }
    const std::vector<double> radii = radii_of_vertices(used);
    for (EdgeId id = 0; id < _base.edge_count(); ++id) {
      BaseEdgeFate& fate = _closed.fates[id];
      if (fate.kind != BaseEdgeFate::Kind::kept || !used[id]) continue;
      fate.edge = static_cast<EdgeId>(to.edges.size());
      Edge edge = from.edges[id];
      EdgeEvaluator evaluator = from.edge_evaluators[id];
      const EndMove first = end_move(radii, id, edge.first), last = end_move(radii, id, edge.last);
      const bool moved = first.by != Vec3{} || last.by != Vec3{};
      if (moved && !edge.degenerate) {
        evaluator.curve = GeomAdaptor_Curve(move_ends(evaluator.curve, first, last), edge.first_parameter,
                                            edge.last_parameter);
      }
      edge.first = _roots->root(edge.first), edge.last = _roots->root(edge.last);
      to.edges.push_back(std::move(edge));
      to.edge_evaluators.push_back(std::move(evaluator));
      to.edge_snaps.push_back(from.edge_snaps[id]);
      _closed.base_edges.push_back(id);
      _closed.moved.push_back(moved ? 1 : 0);
    }
  }

  /// From one end of an edge to the other; a fraction of the length where both are one.
  double radius_of_edge(EdgeId id) const {
    constexpr double fraction_of_closed_edge =
        0.25;  // to either side of its vertex, so that half of it stays
    const Edge& edge = _base.edge(id);
    if (edge.first == edge.last) return fraction_of_closed_edge * rough_length(_base, id);
    return distance(_base.vertex(edge.first), _base.vertex(edge.last));
  }

  /// How far around each vertex of the base model edges follow its move: as far as the shortest of them goes,
  /// but for very short ones.
  std::vector<double> radii_of_vertices(const std::vector<char>& used) const {
    constexpr double short_edge =
        20;  // in moves: over less, a move would show as a bend of more than 3 degrees
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    std::vector<double> radii(_base.vertex_count(), unlimited);
    for (EdgeId id = 0; id < _base.edge_count(); ++id) {
      const Edge& edge = _base.edge(id);
      if (!used[id] || edge.degenerate || _closed.fates[id].kind != BaseEdgeFate::Kind::kept) continue;
      const double radius = radius_of_edge(id);
      for (const VertexId v : {edge.first, edge.last}) {
        if (radius > short_edge * distance(_places[v], _base.vertex(v)))
          radii[v] = std::min(radii[v], radius);
      }
    }
    return radii;
  }

  EndMove end_move(const std::vector<double>& radii, EdgeId id, VertexId v) const {
    const Vec3 from = _base.vertex(v);
    return {from, _places[v] - from, std::min(radii[v], radius_of_edge(id))};
  }

  /// The edges that take a strip's place.
  void add_middles(std::size_t i) {
    const BluntEdge& strip = _strips[i];
    for (std::size_t k = 1; k < _stations[i].size(); ++k) {
      Edge edge;
      edge.first = root(i, k - 1), edge.last = root(i, k);
      MiddleCurve middle = draw_middle(_paths[i], _stations[i][k - 1], _stations[i][k], _places[edge.first],
                                       _places[edge.last]);
      edge.first_parameter = middle.parameters.front(), edge.last_parameter = middle.parameters.back();
      EdgeEvaluator evaluator;
      evaluator.curve.Load(middle.curve, edge.first_parameter, edge.last_parameter);
      const auto id = static_cast<EdgeId>(_data->edges.size());
      std::array<BorderPiece, 2> pieces;
      for (int side = 0; side < 2; ++side) {
        const BorderEdge& border = strip.borders[side][middle.edges[side]];
        pieces[side] = {border.neighbour, coedge_along(_base, border.neighbour, border.strip_use.edge),
                        middle.parameters, std::move(middle.border_parameters[side])};
        _closed.fates[border.strip_use.edge].pieces.push_back(id);
      }
      _closed.closed.push_back(std::move(pieces));
      _closed.base_edges.push_back(no_entity);
      _closed.moved.push_back(1);
      _data->edges.push_back(std::move(edge));
      _data->edge_evaluators.push_back(std::move(evaluator));
      _data->edge_snaps.emplace_back();
    }
    for (int side = 0; side < 2; ++side) {
      for (const BorderEdge& border : strip.borders[side]) {
        auto& pieces = _closed.fates[border.strip_use.edge].pieces;
        if (border.against) std::reverse(pieces.begin(), pieces.end());
      }
    }
  }

  void rewrite_loops() {
    for (FaceId id = 0; id < static_cast<FaceId>(_data->faces.size()); ++id) {
      for (auto& loop : _data->faces[id].loops) {
        std::vector<Coedge> now;
        for (const Coedge& use : loop) append_coedges(_closed.base_faces[id], use, now);
        if (now.empty()) {
          throw CadError(fmt::format("face '{}' would vanish if the strips beside it were closed",
                                     _data->faces[id].name));
        }
        loop = std::move(now);
      }
      require_simple(id);
    }
    for (Edge& edge : _data->edges) edge.faces.clear();
    for (FaceId id = 0; id < static_cast<FaceId>(_data->faces.size()); ++id) {
      for (const Coedge& use : _data->faces[id].loops | std::views::join) {
        auto& users = _data->edges[use.edge].faces;
        if (users.empty() || users.back() != id) users.push_back(id);
      }
    }
  }

  /// Where a strip's end was all that kept two pieces of a loop apart, the face would touch itself there.
  void require_simple(FaceId id) {
    std::map<VertexId, int> before, allowed, now;  // how often loops come by
    const auto count = [](const Edge& edge, const Coedge& use, std::map<VertexId, int>& visits) {
      ++visits[use.reversed ? edge.last : edge.first];
    };
    for (const Coedge& use : _base.face(_closed.base_faces[id]).loops | std::views::join)
      count(_base.edge(use.edge), use, before);
    for (const Coedge& use : _data->faces[id].loops | std::views::join)
      count(_data->edges[use.edge], use, now);
    for (const auto& [v, visits] : before) {
      int& most = allowed[_roots->root(v)];
      most = std::max(most, visits);
    }
    for (const auto& [v, visits] : now) {
      if (visits <= std::max(1, allowed[v])) continue;
      throw CadError(fmt::format("face '{}' would touch itself at {}", _data->faces[id].name,
                                 place_in_file(_places[v])));
    }
  }

  void append_coedges(FaceId base_face, const Coedge& use, std::vector<Coedge>& loop) const {
    const BaseEdgeFate& fate = _closed.fates[use.edge];
    if (fate.kind == BaseEdgeFate::Kind::kept) loop.push_back({fate.edge, use.use, use.reversed});
    const std::size_t first = loop.size();
    for (const EdgeId id : fate.pieces)
      loop.push_back({id, 0, use.reversed == _closed.piece(id, base_face).is_along()});
    if (use.reversed) std::reverse(loop.begin() + static_cast<std::ptrdiff_t>(first), loop.end());
  }

  /// Vertices in use, by their joined numbers.
  void number_vertices() {
    std::vector<VertexId> number(_places.size(), no_entity);
    for (const Edge& edge : _data->edges) number[edge.first] = number[edge.last] = 0;
    const std::vector<Snap> snaps = std::move(_data->vertex_snaps);
    _data->vertices.clear();
    _data->vertex_snaps.clear();
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == no_entity) continue;
      number[v] = static_cast<VertexId>(_data->vertices.size());
      const bool as_it_was = v < snaps.size() && _places[v] == _base.vertex(static_cast<VertexId>(v));
      _data->vertices.push_back(_places[v]);
      _data->vertex_snaps.push_back(as_it_was ? snaps[v] : Snap{});
    }
    for (Edge& edge : _data->edges) edge.first = number[edge.first], edge.last = number[edge.last];
  }

  const Model& _base;
  std::vector<BluntEdge> _strips;
  ClosedEdges _closed;
  std::shared_ptr<Model::Data> _data;
  std::vector<std::array<BorderPath, 2>> _paths;
  std::vector<std::vector<Station>> _stations;
  std::vector<std::vector<VertexId>> _station_vertices;    // their numbers before they are joined
  std::optional<geometry::DisjointSets<VertexId>> _roots;  // of vertices that become one
  std::vector<Vec3> _places;                               // of joined vertices, by any of their numbers
};

}  // namespace

Model close_blunt_edges(const Model& model, const std::vector<BluntEdge>& strips) {
  if (const ScaledModel* scaled = model.data().scaled.get()) {
    const InLibraryUnit at_hand(scaled->unit);
    const Model inner = within(model);
    std::vector<BluntEdge> same;
    same.reserve(strips.size());
    for (const BluntEdge& strip : strips) same.push_back(examine_blunt_edge(inner, strip.face, 0).edge);
    return in_file_unit(close_blunt_edges(inner, same), scaled->unit);
  }
  if (model.data().joined || model.data().closed)
    throw std::invalid_argument("edges of this model are closed or faces joined already");
  return guarded("closing blunt edges", [&] {
    if (!model.data().faceted) return Closing(model, strips).run();
    return with_facets_of(model, Closing(without_facets(model), strips).run());
  });
}

}  // namespace aeroloom::cad
