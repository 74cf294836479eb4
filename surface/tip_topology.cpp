#include "surface/tip_topology.hpp"

#include "mesh/tokens.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace aeroloom::surface {

using mesh::LocalIndex;
using mesh::Piece;

std::vector<CurveVertex> curve_vertices(const CurveMesh& curves, const Piece& piece) {
  std::vector<CurveVertex> result(piece.vertex_count(), -1);
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    if (!mesh::is_cut_token(piece.shared_tokens[s]))
      result[piece.shared_vertices[s]] = curves.vertex_of(piece.shared_tokens[s]);
  }
  return result;
}

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

std::int32_t level_in_tip(const LocalIndex* triangle, const std::vector<std::int32_t>& ranks) {
  std::int32_t highest = 0;
  for (int k = 0; k < 3; ++k) {
    if (ranks[triangle[k]] < 0) return -1;
    highest = std::max(highest, ranks[triangle[k]]);
  }
  return highest;
}

namespace {

/// How many pairs of a tip can be closed, by what its piece holds.
struct Closing {
  std::int32_t tip;
  std::int32_t pairs;
};

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
      const std::int32_t own = level_in_tip(v, _ranks);
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
    const std::int32_t own = level_in_tip(piece.cell(t), ranks);
    if (own >= 0) ++triangles[own];
  }
  std::int32_t best = 0, sum = triangles[0];
  for (std::int32_t i = 1; i < static_cast<std::int32_t>(triangles.size()); ++i) {
    sum += triangles[i];
    if (sum == 2 * i - 1 && sum + 1 < piece.cell_count()) best = i;
  }
  return best > 0 && Surroundings(piece, ranks, best).let_close() ? best : 0;
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

/// What triangles of other faces than a tip's own would do to it.
class Neighbourhood {
public:
  Neighbourhood(const CurveMesh& curves, const std::vector<Tip>& tips) : _curves(curves), _tips(tips) {
    for (std::size_t i = 0; i < tips.size(); ++i) {
      const auto tip = static_cast<std::int32_t>(i);
      std::array<CurveVertex, 2> before{tips[i].vertex, tips[i].vertex};
      std::int32_t step = 0;
      for (const auto& pair : tips[i].pairs) {
        _steps[std::minmax(pair[0], pair[1])].push_back({tip, across});
        for (int side = 0; side < 2; ++side)
          _steps[std::minmax(before[side], pair[side])].push_back({tip, step});
        before = pair;
        ++step;
      }
    }
  }

  /// Tips that stay open: other faces join the two curves, or have triangles on both that would become one.
  /// Collective.
  std::vector<char> open_tips(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface) {
    for (const Piece& piece : surface.pieces) visit(piece);
    std::vector<char> open(_tips.size(), 0);
    for (const std::int32_t tip : communicator.all_gather_items<std::int32_t>(_bridged)) open[tip] = 1;
    std::vector<Fan> fans = communicator.all_gather_items<Fan>(_fans);
    std::sort(fans.begin(), fans.end());
    for (std::size_t i = 1; i < fans.size(); ++i) {
      if (fans[i] == fans[i - 1]) open[fans[i][0]] = 1;
    }
    return open;
  }

private:
  static constexpr std::int32_t across = -1;
  /// A tip, a segment of its curves by its number from the CAD vertex on, and the vertex of a curve that a
  /// triangle on the segment has opposite.
  using Fan = std::array<std::int32_t, 3>;
  struct Step {
    std::int32_t tip, step;  // across: between the vertices of a pair
  };

  void visit(const Piece& piece) {
    const std::vector<CurveVertex> on_curve = curve_vertices(_curves, piece);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      for (int k = 0; k < 3; ++k) {
        const CurveVertex a = on_curve[v[k]], b = on_curve[v[(k + 1) % 3]], c = on_curve[v[(k + 2) % 3]];
        if (a < 0 || b < 0) continue;
        const auto found = _steps.find(std::minmax(a, b));
        if (found == _steps.end()) continue;
        for (const Step& step : found->second) {
          if (_tips[step.tip].face == piece.common_face()) continue;
          if (step.step == across)
            _bridged.push_back(step.tip);
          else if (c >= 0)
            _fans.push_back({step.tip, step.step, c});
        }
      }
    }
  }

  const CurveMesh& _curves;
  const std::vector<Tip>& _tips;
  std::map<std::pair<CurveVertex, CurveVertex>, std::vector<Step>> _steps;
  std::vector<std::int32_t> _bridged;  // tips, on this rank
  std::vector<Fan> _fans;              // on this rank
};

/// Without tips that other faces keep open. Collective.
std::vector<Tip> without_open(const parallel::Communicator& communicator, const CurveMesh& curves,
                              const mesh::DistributedMesh& surface, std::vector<Tip> tips) {
  const std::vector<char> open = Neighbourhood(curves, tips).open_tips(communicator, surface);
  std::vector<Tip> rest;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    if (!open[i]) rest.push_back(std::move(tips[i]));
  }
  return rest;
}

}  // namespace

std::vector<Tip> closable_tips(const parallel::Communicator& communicator, const CurveMesh& curves,
                               const mesh::DistributedMesh& surface, std::vector<Tip> tips) {
  tips = agree_on_tips(communicator, curves, surface, std::move(tips));
  return tips.empty() ? tips : without_open(communicator, curves, surface, std::move(tips));
}

}  // namespace aeroloom::surface
