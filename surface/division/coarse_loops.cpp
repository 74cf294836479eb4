#include "surface/division/coarse_loops.hpp"

#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace aeroloom::surface {
namespace {

/// The loops as closed sequences of vertices of the piece problem, in the order of the loop edges. The same
/// vertex may occur several times where the border touches itself.
std::vector<std::vector<std::int32_t>> trace_loops(const ChartSurface& surface) {
  std::vector<std::int32_t> next(surface.points.size(), -1);
  for (const auto& [from, to] : surface.loop_edges) next[from] = to;
  std::vector<std::vector<std::int32_t>> loops;
  for (const auto& [first, second] : surface.loop_edges) {
    std::vector<std::int32_t> loop;
    for (std::int32_t p = first; next[p] >= 0;) {
      loop.push_back(surface.mesh_vertex[p]);
      const std::int32_t after = next[p];
      next[p] = -1;
      p = after;
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

/// One loop, turned so that it begins at its sharpest corner.
class LoopCoarsener {
public:
  LoopCoarsener(const PieceProblem& problem, const sizing::SizeField& coarse, double largest_turn,
                std::vector<std::int32_t> loop)
      : _points(problem.vertices.points),
        _coarse(coarse),
        _largest_turn(largest_turn),
        _loop(std::move(loop)) {
    const std::size_t count = _loop.size();
    std::size_t sharpest = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if (turn(i) > turn(sharpest)) sharpest = i;
    }
    std::rotate(_loop.begin(), _loop.begin() + static_cast<std::ptrdiff_t>(sharpest), _loop.end());
    _worth.push_back(0);
    for (std::size_t i = 0; i < count; ++i) _worth.push_back(_worth.back() + worth(i));
  }

  std::size_t size() const { return _loop.size(); }
  std::int32_t vertex(std::size_t i) const { return _loop[i % _loop.size()]; }

  /// Positions in the loop that are kept, ascending, 0 first and size() last.
  std::vector<std::size_t> choose() const {
    std::vector<std::size_t> kept{0};
    for (std::size_t i = 1; i <= size(); ++i) {
      if (i == size() || turn(i) > _largest_turn) spread(kept.back(), i, kept);
    }
    while (kept.size() < 4 && kept.size() < size() + 1) divide_longest(kept);
    return kept;
  }

  /// The position that divides a stretch best.
  std::size_t middle(std::size_t from, std::size_t to) const {
    const double half = 0.5 * (_worth[from] + _worth[to]);
    const auto at = std::lower_bound(_worth.begin(), _worth.end(), half) - _worth.begin();
    return std::clamp(static_cast<std::size_t>(at), from + 1, to - 1);
  }

private:
  geometry::Vec3 step(std::size_t i) const { return _points[vertex(i + 1)] - _points[vertex(i)]; }
  double turn(std::size_t i) const { return angle_between(step(i + size() - 1), step(i)); }

  /// How many coarse segments the fine one that starts at i is worth.
  double worth(std::size_t i) const {
    const auto bend = [&](std::size_t k) {
      const double angle = turn(k);
      return angle > _largest_turn ? 0 : 0.5 * angle / _largest_turn;
    };
    const geometry::Vec3 from = _points[vertex(i)];
    return std::max(norm(step(i)) / _coarse(from + 0.5 * step(i)), bend(i) + bend(i + 1));
  }

  /// Appends positions after `from` up to `to`.
  void spread(std::size_t from, std::size_t to, std::vector<std::size_t>& kept) const {
    const double total = _worth[to] - _worth[from];
    const auto segments = std::min(static_cast<std::size_t>(std::max(1.0, std::round(total))), to - from);
    std::size_t last = from;
    for (std::size_t k = 1; k < segments; ++k) {
      const double wanted = _worth[from] + total * static_cast<double>(k) / static_cast<double>(segments);
      auto at =
          static_cast<std::size_t>(std::lower_bound(_worth.begin(), _worth.end(), wanted) - _worth.begin());
      if (at > 0 && wanted - _worth[at - 1] < _worth[at] - wanted) --at;
      // Every segment has a fine edge at least.
      last = std::clamp(at, last + 1, to - (segments - k));
      kept.push_back(last);
    }
    kept.push_back(to);
  }

  void divide_longest(std::vector<std::size_t>& kept) const {
    std::size_t longest = 0;
    for (std::size_t i = 1; i < kept.size(); ++i) {
      if (longest == 0 || kept[i] - kept[i - 1] > kept[longest] - kept[longest - 1]) longest = i;
    }
    const std::size_t at = middle(kept[longest - 1], kept[longest]);
    kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(longest), at);
  }

  const std::vector<geometry::Vec3>& _points;
  const sizing::SizeField& _coarse;
  double _largest_turn;
  std::vector<std::int32_t> _loop;
  std::vector<double> _worth;  // up to each position
};

}  // namespace

const CoarseSegment* CoarseLoops::find(std::int32_t from, std::int32_t to) const {
  for (const auto& [a, b] : {std::pair{from, to}, std::pair{to, from}}) {
    const auto at =
        std::lower_bound(segments.begin(), segments.end(), std::pair{a, b},
                         [](const CoarseSegment& s, const std::pair<std::int32_t, std::int32_t>& k) {
                           return std::pair{s.from, s.to} < k;
                         });
    if (at != segments.end() && at->from == a && at->to == b) return &*at;
  }
  return nullptr;
}

CoarseLoops coarsen_loops(const PieceProblem& problem, const sizing::SizeField& coarse, double largest_turn) {
  CoarseLoops result;
  std::set<std::array<std::int32_t, 2>> joined;
  for (auto& loop : trace_loops(problem.surface)) {
    const LoopCoarsener coarsener(problem, coarse, largest_turn, std::move(loop));
    std::vector<std::size_t> kept = coarsener.choose();
    for (std::size_t i = 1; i < kept.size(); ++i) {
      // A second segment between the same vertices is divided where it can be.
      const auto joins = [&] {
        const std::int32_t a = coarsener.vertex(kept[i - 1]), b = coarsener.vertex(kept[i]);
        return std::array{std::min(a, b), std::max(a, b)};
      };
      while (joined.contains(joins()) && kept[i] - kept[i - 1] > 1)
        kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(i), coarsener.middle(kept[i - 1], kept[i]));
      joined.insert(joins());
      CoarseSegment segment{coarsener.vertex(kept[i - 1]), coarsener.vertex(kept[i]),
                            static_cast<std::int32_t>(result.inside.size()), 0};
      for (std::size_t k = kept[i - 1] + 1; k < kept[i]; ++k) result.inside.push_back(coarsener.vertex(k));
      segment.end = static_cast<std::int32_t>(result.inside.size());
      result.segments.push_back(segment);
    }
  }
  std::sort(result.segments.begin(), result.segments.end(),
            [](const CoarseSegment& a, const CoarseSegment& b) {
              return std::tie(a.from, a.to) < std::tie(b.from, b.to);
            });
  return result;
}

}  // namespace aeroloom::surface
