#include "surface/cusps/cusp_topology.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <compare>
#include <iterator>
#include <map>
#include <utility>

namespace aeroloom::surface {

using mesh::LocalIndex;
using mesh::Piece;

std::vector<CurveVertex> curve_vertices(const CurveMesh& curves, const Piece& piece) {
  std::vector<CurveVertex> result(piece.vertex_count(), -1);
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    if (!mesh::is_cut_vertex_key(piece.shared_keys[s]))
      result[piece.shared_vertices[s]] = curves.vertex_of(piece.shared_keys[s]);
  }
  return result;
}

std::vector<std::int32_t> levels_in_cusp(const Cusp& cusp, const std::vector<CurveVertex>& on_curve) {
  std::map<CurveVertex, std::int32_t> rank{{cusp.vertex, 0}};
  for (std::size_t i = 0; i < cusp.pairs.size(); ++i) {
    for (const CurveVertex v : cusp.pairs[i]) rank[v] = static_cast<std::int32_t>(i) + 1;
  }
  std::vector<std::int32_t> ranks(on_curve.size(), -1);
  for (std::size_t v = 0; v < on_curve.size(); ++v) {
    const auto found = on_curve[v] < 0 ? rank.end() : rank.find(on_curve[v]);
    if (found != rank.end()) ranks[v] = found->second;
  }
  return ranks;
}

std::int32_t level_of_triangle(const LocalIndex* triangle, const std::vector<std::int32_t>& ranks) {
  std::int32_t highest = 0;
  for (int k = 0; k < 3; ++k) {
    if (ranks[triangle[k]] < 0) return -1;
    highest = std::max(highest, ranks[triangle[k]]);
  }
  return highest;
}

namespace {

/// How many pairs of a cusp can be closed, by what its piece holds.
struct Closing {
  std::int32_t cusp;
  std::int32_t pairs;
};

/// How the triangles after a cusp's first `pairs` pairs know its vertices.
class PairSurroundings {
public:
  PairSurroundings(const Piece& piece, const std::vector<std::int32_t>& ranks, std::int32_t pairs)
      : _piece(piece), _ranks(ranks), _pairs(pairs) {}

  /// One triangle, after the last pair, has both vertices of a pair, and what closes does not fold others.
  bool let_close() {
    std::map<LocalIndex, std::vector<LocalIndex>> neighbours;  // of the vertices of the last pair
    int closing = 0;
    for (LocalIndex t = 0; t < _piece.cell_count(); ++t) {
      const LocalIndex* v = _piece.cell(t);
      const std::int32_t own = level_of_triangle(v, _ranks);
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

  /// Vertices, not of the cusp, next to both vertices of the last pair.
  static std::size_t common(std::map<LocalIndex, std::vector<LocalIndex>>& neighbours) {
    std::vector<std::vector<LocalIndex>> sorted;
    for (auto& [vertex, next] : neighbours) {
      geometry::sort_unique(next);
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
std::int32_t closable_pairs(const Piece& piece, const Cusp& cusp, const std::vector<CurveVertex>& on_curve) {
  const std::vector<std::int32_t> ranks = levels_in_cusp(cusp, on_curve);
  std::vector<std::int32_t> triangles(cusp.pairs.size() + 1, 0);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const std::int32_t own = level_of_triangle(piece.cell(t), ranks);
    if (own >= 0) ++triangles[own];
  }
  std::int32_t best = 0, sum = triangles[0];
  for (std::int32_t i = 1; i < static_cast<std::int32_t>(triangles.size()); ++i) {
    sum += triangles[i];
    if (sum == 2 * i - 1 && sum + 1 < piece.cell_count()) best = i;
  }
  return best > 0 && PairSurroundings(piece, ranks, best).let_close() ? best : 0;
}

/// Cusps whose pieces let them close, cut to the pairs that do. Collective.
std::vector<Cusp> agree_on_cusps(const CurveMesh& curves, const mesh::DistributedMesh& surface,
                                 std::vector<Cusp> cusps) {
  std::vector<Closing> mine;
  parallel::agree(surface.communicator, [&] {
    for (const Piece& piece : surface.pieces) {
      std::vector<CurveVertex> on_curve;
      for (std::size_t i = 0; i < cusps.size(); ++i) {
        if (cusps[i].face != piece.common_face()) continue;
        if (on_curve.empty()) on_curve = curve_vertices(curves, piece);
        const std::int32_t pairs = closable_pairs(piece, cusps[i], on_curve);
        if (pairs > 0) mine.push_back({static_cast<std::int32_t>(i), pairs});
      }
    }
  });
  std::vector<std::int32_t> pairs(cusps.size(), 0);
  for (const Closing& closing : surface.communicator.all_gather_items<Closing>(mine))
    pairs[closing.cusp] = std::max(pairs[closing.cusp], closing.pairs);
  for (std::size_t i = 0; i < cusps.size(); ++i) cusps[i].pairs.resize(pairs[i]);
  std::erase_if(cusps, [](const Cusp& cusp) { return cusp.pairs.empty(); });
  return cusps;
}

/// A triangle whose vertices all lie on curves.
struct CurveTriangle {
  std::array<CurveVertex, 3> vertices;
  cad::FaceId face;
  auto operator<=>(const CurveTriangle&) const = default;
};

/// The triangles around cusps after these have closed.
class Closure {
public:
  Closure(std::size_t curve_vertices, const std::vector<Cusp>& cusps)
      : _cusps(cusps), _open(cusps.size(), 0), _sets(curve_vertices) {
    for (std::size_t i = 0; i < cusps.size(); ++i) {
      for (const auto& pair : cusps[i].pairs) {
        for (const CurveVertex v : pair) _cusps_at[v].push_back(i);
      }
    }
  }

  /// Triangles around the cusps, on this rank.
  std::vector<CurveTriangle> collect(const CurveMesh& curves, const mesh::DistributedMesh& surface) const {
    std::vector<CurveTriangle> result;
    for (const Piece& piece : surface.pieces) {
      const std::vector<CurveVertex> on_curve = curve_vertices(curves, piece);
      for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
        const LocalIndex* v = piece.cell(t);
        const CurveTriangle triangle{{on_curve[v[0]], on_curve[v[1]], on_curve[v[2]]}, piece.common_face()};
        const auto& all = triangle.vertices;
        const bool on_curves = std::min({all[0], all[1], all[2]}) >= 0;
        if (on_curves &&
            std::any_of(all.begin(), all.end(), [&](auto each) { return _cusps_at.contains(each); }))
          result.push_back(triangle);
      }
    }
    return result;
  }

  /// Opens cusps, the last one first, until no triangle of another face loses an edge and no two become one.
  const std::vector<char>& open_needed(const std::vector<CurveTriangle>& triangles) {
    while (open_one(triangles)) {
    }
    return _open;
  }

private:
  bool open_one(const std::vector<CurveTriangle>& triangles) {
    _sets = geometry::DisjointSets<CurveVertex>(_sets.size());
    for (std::size_t i = 0; i < _cusps.size(); ++i) {
      if (_open[i]) continue;
      for (const auto& [a, b] : _cusps[i].pairs) _sets.unite(a, b);
    }
    std::vector<std::array<CurveVertex, 6>> left;  // what vertices become, ascending, and what they are
    for (const CurveTriangle& triangle : triangles) {
      if (vanishes(triangle)) continue;
      const auto& [a, b, c] = triangle.vertices;
      std::array<CurveVertex, 3> now{_sets.root(a), _sets.root(b), _sets.root(c)};
      std::sort(now.begin(), now.end());
      if ((now[0] == now[1] || now[1] == now[2]) && !ends(triangle)) return open_last({a, b, c});
      if (now[0] != now[1] && now[1] != now[2]) left.push_back({now[0], now[1], now[2], a, b, c});
    }
    std::sort(left.begin(), left.end());
    for (std::size_t i = 1; i < left.size(); ++i) {
      if (std::equal(left[i].begin(), left[i].begin() + 3, left[i - 1].begin()))
        return open_last(
            {left[i][3], left[i][4], left[i][5], left[i - 1][3], left[i - 1][4], left[i - 1][5]});
    }
    return false;
  }

  /// Whether it lies between the curves of a cusp of its face.
  bool vanishes(const CurveTriangle& triangle) const { return vertices_in_own_cusp(triangle) == 3; }
  /// Whether it is next to the last pair of a cusp of its face.
  bool ends(const CurveTriangle& triangle) const { return vertices_in_own_cusp(triangle) == 2; }
  std::ptrdiff_t vertices_in_own_cusp(const CurveTriangle& triangle) const {
    std::ptrdiff_t most = 0;
    for (const CurveVertex v : triangle.vertices) {
      const auto found = _cusps_at.find(v);
      if (found == _cusps_at.end()) continue;
      for (const std::size_t cusp : found->second) {
        if (_open[cusp] || _cusps[cusp].face != triangle.face) continue;
        most = std::max(most, std::count_if(triangle.vertices.begin(), triangle.vertices.end(),
                                            [&](CurveVertex w) { return is_in(w, cusp); }));
      }
    }
    return most;
  }
  bool is_in(CurveVertex v, std::size_t cusp) const {
    if (v == _cusps[cusp].vertex) return true;
    const auto found = _cusps_at.find(v);
    return found != _cusps_at.end() &&
           std::find(found->second.begin(), found->second.end(), cusp) != found->second.end();
  }

  /// The last of the cusps that some vertices are in. False where all are open.
  bool open_last(const std::vector<CurveVertex>& vertices) {
    std::ptrdiff_t last = -1;
    for (const CurveVertex v : vertices) {
      const auto found = _cusps_at.find(v);
      if (found == _cusps_at.end()) continue;
      for (const std::size_t cusp : found->second) {
        if (!_open[cusp]) last = std::max(last, static_cast<std::ptrdiff_t>(cusp));
      }
    }
    if (last < 0) return false;
    _open[last] = 1;
    return true;
  }

  const std::vector<Cusp>& _cusps;
  std::vector<char> _open;
  std::map<CurveVertex, std::vector<std::size_t>> _cusps_at;  // of vertices in pairs
  geometry::DisjointSets<CurveVertex> _sets;
};

/// Without cusps that other faces keep open. Collective.
std::vector<Cusp> without_open(const CurveMesh& curves, const mesh::DistributedMesh& surface,
                               std::vector<Cusp> cusps) {
  Closure closure(curves.points.size(), cusps);
  // Sorted, since their order decides which cusp opens first.
  const std::vector<CurveTriangle> triangles =
      surface.communicator.gather_sorted(closure.collect(curves, surface));
  const std::vector<char>& open = closure.open_needed(triangles);
  std::vector<Cusp> rest;
  for (std::size_t i = 0; i < cusps.size(); ++i) {
    if (!open[i]) rest.push_back(std::move(cusps[i]));
  }
  return rest;
}

}  // namespace

std::vector<Cusp> closable_cusps(const CurveMesh& curves, const mesh::DistributedMesh& surface,
                                 std::vector<Cusp> cusps) {
  cusps = agree_on_cusps(curves, surface, std::move(cusps));
  return cusps.empty() ? cusps : without_open(curves, surface, std::move(cusps));
}

}  // namespace aeroloom::surface
