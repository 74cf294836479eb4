#include "surface/cusp_tips.hpp"

#include "mesh/tokens.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// The vertices of two curves that could become one, from the CAD vertex on.
struct Tip {
  cad::FaceId face;
  cad::VertexId vertex;
  std::vector<std::array<CurveVertex, 2>> pairs;
};

/// How many pairs of a tip can be closed, by what its piece holds.
struct Closing {
  std::int32_t tip;
  std::int32_t pairs;
};

/// The vertices of an edge from one of its ends up to the middle.
std::vector<CurveVertex> near_half(const Model& model, const CurveMesh& curves, cad::EdgeEnd end) {
  std::vector<CurveVertex> chain = curves.chain(model, end.edge);
  if (!end.first) std::reverse(chain.begin(), chain.end());
  chain.resize((chain.size() + 1) / 2);
  return chain;
}

double distance_to_segment(Vec3 p, Vec3 from, Vec3 to) {
  const Vec3 along = to - from;
  const double t = std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
  return distance(p, from + t * along);
}

/// The points of a half edge from the CAD vertex on.
struct Side {
  std::vector<CurveVertex> vertices;
  std::vector<Vec3> points;

  Side(const Model& model, const CurveMesh& curves, cad::EdgeEnd end)
      : vertices(near_half(model, curves, end)) {
    for (const CurveVertex v : vertices) points.push_back(curves.points[v]);
  }
  /// Of the two segments that end at vertex i.
  double shorter_segment(std::size_t i) const {
    return std::min(distance(points[i - 1], points[i]), distance(points[i], points[i + 1]));
  }
  /// How far a point is from them.
  double distance_from(Vec3 p, std::size_t i) const {
    return std::min(distance_to_segment(p, points[i - 1], points[i]),
                    distance_to_segment(p, points[i], points[i + 1]));
  }
};

Tip measure_tip(const Model& model, const CurveMesh& curves, double widest, const SharpCorner& corner) {
  Tip tip{corner.face, corner.vertex, {}};
  const Side a(model, curves, corner.ends[0]), b(model, curves, corner.ends[1]);
  for (std::size_t i = 1; i + 1 < std::min(a.points.size(), b.points.size()); ++i) {
    const double segment = std::min(a.shorter_segment(i), b.shorter_segment(i));
    const double gap = std::max(a.distance_from(b.points[i], i), b.distance_from(a.points[i], i));
    if (!(gap < std::min(widest, closing_width * segment)) ||
        !(distance(a.points[i], b.points[i]) < closing_width * segment))
      break;
    tip.pairs.push_back({a.vertices[i], b.vertices[i]});
  }
  return tip;
}

/// Which vertex of which curve each vertex of a piece is; -1 for others.
std::vector<CurveVertex> curve_vertices(const CurveMesh& curves, const Piece& piece) {
  std::vector<CurveVertex> result(piece.vertex_count(), -1);
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    if (!mesh::is_cut_token(piece.shared_tokens[s]))
      result[piece.shared_vertices[s]] = curves.vertex_of(piece.shared_tokens[s]);
  }
  return result;
}

/// Ranks of vertices in a tip: 0 the CAD vertex, i the pair i; -1 elsewhere.
std::vector<std::int32_t> ranks_in_tip(const Tip& tip, const std::vector<CurveVertex>& on_curve) {
  std::map<CurveVertex, std::int32_t> rank{{tip.vertex, 0}};
  for (std::size_t i = 0; i < tip.pairs.size(); ++i) {
    for (const CurveVertex v : tip.pairs[i]) rank[v] = static_cast<std::int32_t>(i) + 1;
  }
  std::vector<std::int32_t> ranks(on_curve.size(), -1);
  for (std::size_t v = 0; v < on_curve.size(); ++v) {
    const auto found = on_curve[v] < 0 ? rank.end() : rank.find(on_curve[v]);
    if (found != rank.end()) ranks[v] = found->second;
  }
  return ranks;
}

/// The highest of a triangle's ranks in a tip, -1 where not all of its vertices are in it.
std::int32_t level(const LocalIndex* triangle, const std::vector<std::int32_t>& ranks) {
  std::int32_t highest = 0;
  for (int k = 0; k < 3; ++k) {
    if (ranks[triangle[k]] < 0) return -1;
    highest = std::max(highest, ranks[triangle[k]]);
  }
  return highest;
}

/// How the triangles beyond a tip's first `pairs` pairs know its vertices.
class Surroundings {
public:
  Surroundings(const Piece& piece, const std::vector<std::int32_t>& ranks, std::int32_t pairs)
      : _piece(piece), _ranks(ranks), _pairs(pairs) {}

  /// One triangle, beyond the last pair, has both vertices of a pair, and what closes does not fold others.
  bool let_close() {
    std::map<LocalIndex, std::vector<LocalIndex>> neighbours;  // of the vertices of the last pair
    int closing = 0;
    for (LocalIndex t = 0; t < _piece.cell_count(); ++t) {
      const LocalIndex* v = _piece.cell(t);
      const std::int32_t own = level(v, _ranks);
      if (own >= 0 && own <= _pairs) continue;
      for (int k = 0; k < 3; ++k) {
        const LocalIndex a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
        if (is_closed(a) && _ranks[a] == _ranks[b]) {
          if (_ranks[a] != _pairs) return false;
          ++closing;
        }
        if (_ranks[a] == _pairs) neighbours[a].insert(neighbours[a].end(), {b, c});
      }
    }
    return closing == 1 && neighbours.size() == 2 && common(neighbours) == 1;
  }

private:
  bool is_closed(LocalIndex v) const { return _ranks[v] > 0 && _ranks[v] <= _pairs; }

  /// Vertices, not of the tip, next to both vertices of the last pair.
  static std::size_t common(std::map<LocalIndex, std::vector<LocalIndex>>& neighbours) {
    std::vector<std::vector<LocalIndex>> sorted;
    for (auto& [vertex, next] : neighbours) {
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      sorted.push_back(next);
    }
    std::vector<LocalIndex> both;
    std::set_intersection(sorted[0].begin(), sorted[0].end(), sorted[1].begin(), sorted[1].end(),
                          std::back_inserter(both));
    return both.size();
  }

  const Piece& _piece;
  const std::vector<std::int32_t>& _ranks;
  std::int32_t _pairs;
};

/// How many pairs the triangles of a piece let close: those up to a pair must be all that lie between the
/// curves there.
std::int32_t closable_pairs(const Piece& piece, const Tip& tip, const std::vector<CurveVertex>& on_curve) {
  const std::vector<std::int32_t> ranks = ranks_in_tip(tip, on_curve);
  std::vector<std::int32_t> triangles(tip.pairs.size() + 1, 0);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const std::int32_t own = level(piece.cell(t), ranks);
    if (own >= 0) ++triangles[own];
  }
  std::int32_t best = 0, sum = triangles[0];
  for (std::int32_t i = 1; i < static_cast<std::int32_t>(triangles.size()); ++i) {
    sum += triangles[i];
    if (sum == 2 * i - 1 && sum + 1 < piece.cell_count()) best = i;
  }
  return best > 0 && Surroundings(piece, ranks, best).let_close() ? best : 0;
}

/// Vertices that become one: the lowest stands for all, at their mean.
class ClosedVertices {
public:
  ClosedVertices(const Model& model, const CurveMesh& curves, const std::vector<Tip>& tips)
      : _model(model), _curves(curves) {
    std::map<CurveVertex, CurveVertex> parent;
    auto root = [&parent](CurveVertex v) {
      for (auto at = parent.find(v); at != parent.end() && at->second != v; at = parent.find(v))
        v = at->second;
      return v;
    };
    for (const Tip& tip : tips) {
      for (const auto& pair : tip.pairs) {
        const CurveVertex a = root(pair[0]), b = root(pair[1]);
        parent[std::max(a, b)] = std::min(a, b);
        parent.try_emplace(std::min(a, b), std::min(a, b));
        for (const CurveVertex v : {std::min(a, b), pair[0], pair[1]}) _tip_of[v] = tip.vertex;
      }
    }
    std::map<CurveVertex, std::pair<Vec3, int>> sums;
    for (const auto& [v, unused] : parent) {
      _root[v] = root(v);
      auto& [sum, count] = sums[_root[v]];
      sum += curves.points[v];
      ++count;
    }
    for (const auto& [v, sum] : sums) _point[v] = (1.0 / sum.second) * sum.first;
  }

  /// The vertex that stands for v; v itself where nothing closes.
  CurveVertex root(CurveVertex v) const {
    const auto found = _root.find(v);
    return found == _root.end() ? v : found->second;
  }
  bool contains(CurveVertex v) const { return _root.contains(v); }
  Vec3 point(CurveVertex v) const { return _point.at(root(v)); }
  cad::VertexId tip_of(CurveVertex v) const { return _tip_of.at(root(v)); }
  mesh::SharedToken token(CurveVertex v) const { return _curves.token(_model, root(v)); }

private:
  const Model& _model;
  const CurveMesh& _curves;
  std::map<CurveVertex, CurveVertex> _root;
  std::map<CurveVertex, Vec3> _point;
  std::map<CurveVertex, cad::VertexId> _tip_of;
};

/// The piece with vertices that closed, without the triangles that vanish.
Piece close_piece(const Piece& piece, const std::vector<CurveVertex>& on_curve, const ClosedVertices& closed,
                  const std::vector<const Tip*>& tips) {
  std::vector<char> vanishes(piece.cell_count(), 0);
  for (const Tip* tip : tips) {
    const auto ranks = ranks_in_tip(*tip, on_curve);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) vanishes[t] |= level(piece.cell(t), ranks) >= 0;
  }
  std::vector<LocalIndex> stands_for(piece.vertex_count());
  std::iota(stands_for.begin(), stands_for.end(), 0);
  std::map<CurveVertex, LocalIndex> first;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (on_curve[v] >= 0 && closed.contains(on_curve[v]))
      stands_for[v] = first.try_emplace(closed.root(on_curve[v]), v).first->second;
  }
  Piece result{.id = piece.id, .kind = piece.kind, .region = piece.region};
  std::vector<char> used(piece.vertex_count(), 0);
  std::vector<std::array<LocalIndex, 3>> kept;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    const std::array<LocalIndex, 3> now{stands_for[v[0]], stands_for[v[1]], stands_for[v[2]]};
    if (vanishes[t] || now[0] == now[1] || now[1] == now[2] || now[2] == now[0]) continue;
    kept.push_back(now);
    result.triangle_face.push_back(piece.triangle_face[t]);
    result.triangle_patch.push_back(piece.triangle_patch[t]);
    for (const LocalIndex w : now) used[w] = 1;
  }
  std::vector<LocalIndex> number(piece.vertex_count(), -1);
  std::size_t s = 0;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const bool shared = s < piece.shared_vertices.size() && piece.shared_vertices[s] == v;
    const mesh::SharedToken token = shared ? piece.shared_tokens[s++] : 0;
    if (!used[v]) continue;
    number[v] = result.vertex_count();
    const bool moves = on_curve[v] >= 0 && closed.contains(on_curve[v]);
    const Vec3 p = moves ? closed.point(on_curve[v]) : piece.point(v);
    result.coordinates.insert(result.coordinates.end(), {p.x, p.y, p.z});
    result.vertex_dimension.push_back(moves ? std::int8_t{0} : piece.vertex_dimension[v]);
    result.vertex_entity.push_back(moves ? closed.tip_of(on_curve[v]) : piece.vertex_entity[v]);
    if (!shared) continue;
    result.shared_vertices.push_back(number[v]);
    result.shared_tokens.push_back(moves ? closed.token(on_curve[v]) : token);
  }
  for (const auto& triangle : kept) {
    for (const LocalIndex v : triangle) result.cells.push_back(number[v]);
  }
  return result;
}

/// Tips whose pieces let them close, cut to the pairs that do. Collective.
std::vector<Tip> agree_on_tips(const parallel::Communicator& communicator, const CurveMesh& curves,
                               const mesh::DistributedMesh& surface, std::vector<Tip> tips) {
  std::vector<Closing> mine;
  parallel::agree(communicator, [&] {
    for (const Piece& piece : surface.pieces) {
      std::vector<CurveVertex> on_curve;
      for (std::size_t i = 0; i < tips.size(); ++i) {
        if (tips[i].face != piece.common_face()) continue;
        if (on_curve.empty()) on_curve = curve_vertices(curves, piece);
        const std::int32_t pairs = closable_pairs(piece, tips[i], on_curve);
        if (pairs > 0) mine.push_back({static_cast<std::int32_t>(i), pairs});
      }
    }
  });
  std::vector<std::int32_t> pairs(tips.size(), 0);
  for (const Closing& closing : communicator.all_gather_items<Closing>(mine)) {
    pairs[closing.tip] = std::max(pairs[closing.tip], closing.pairs);
  }
  for (std::size_t i = 0; i < tips.size(); ++i) tips[i].pairs.resize(pairs[i]);
  std::erase_if(tips, [](const Tip& tip) { return tip.pairs.empty(); });
  return tips;
}

/// Without tips whose pairs other triangles than their own join. Collective.
std::vector<Tip> without_bridged(const parallel::Communicator& communicator, const CurveMesh& curves,
                                 const mesh::DistributedMesh& surface, std::vector<Tip> tips) {
  std::map<std::pair<CurveVertex, CurveVertex>, std::int32_t> tip_of;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    for (const auto& [a, b] : tips[i].pairs) tip_of[std::minmax(a, b)] = static_cast<std::int32_t>(i);
  }
  std::vector<std::int32_t> mine;
  for (const Piece& piece : surface.pieces) {
    const std::vector<CurveVertex> on_curve = curve_vertices(curves, piece);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      for (int k = 0; k < 3; ++k) {
        const CurveVertex a = on_curve[v[k]], b = on_curve[v[(k + 1) % 3]];
        if (a < 0 || b < 0) continue;
        const auto found = tip_of.find(std::minmax(a, b));
        if (found != tip_of.end() && tips[found->second].face != piece.common_face())
          mine.push_back(found->second);
      }
    }
  }
  std::vector<char> bridged(tips.size(), 0);
  for (const std::int32_t tip : communicator.all_gather_items<std::int32_t>(mine)) bridged[tip] = 1;
  std::vector<Tip> rest;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    if (!bridged[i]) rest.push_back(std::move(tips[i]));
  }
  return rest;
}

std::vector<ClosedTip> describe(const CurveMesh& curves, const std::vector<Tip>& tips,
                                const ClosedVertices& closed) {
  std::vector<ClosedTip> result;
  for (const Tip& tip : tips) {
    ClosedTip row{tip.face, curves.points[tip.vertex], 0, 0};
    for (const auto& pair : tip.pairs) {
      row.length = std::max(row.length, distance(closed.point(pair[0]), row.point));
      for (const CurveVertex v : pair)
        row.moved = std::max(row.moved, distance(closed.point(v), curves.points[v]));
    }
    result.push_back(row);
  }
  return result;
}

}  // namespace

std::vector<ClosedTip> close_cusp_tips(const parallel::Communicator& communicator, const Model& model,
                                       const CurveMesh& curves, double widest, mesh::DistributedMesh& surface,
                                       parallel::StageClock& clock) {
  std::vector<Tip> tips;
  for (const SharpCorner& corner : curves.sharp_corners) {
    Tip tip = measure_tip(model, curves, widest, corner);
    if (!tip.pairs.empty()) tips.push_back(std::move(tip));
  }
  if (tips.empty()) return {};
  tips = agree_on_tips(communicator, curves, surface, std::move(tips));
  if (!tips.empty()) tips = without_bridged(communicator, curves, surface, std::move(tips));
  if (tips.empty()) return {};
  const ClosedVertices closed(model, curves, tips);
  const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::task);
  for (Piece& piece : surface.pieces) {
    const std::vector<CurveVertex> on_curve = curve_vertices(curves, piece);
    const bool touched = std::any_of(on_curve.begin(), on_curve.end(),
                                     [&](CurveVertex v) { return v >= 0 && closed.contains(v); });
    if (!touched) continue;
    std::vector<const Tip*> own;
    for (const Tip& tip : tips) {
      if (tip.face == piece.common_face()) own.push_back(&tip);
    }
    piece = close_piece(piece, on_curve, closed, own);
  }
  return describe(curves, tips, closed);
}

}  // namespace aeroloom::surface
