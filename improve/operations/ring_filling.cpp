#include "improve/operations/ring_filling.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

constexpr double perfect = 1;  // no quality is above: that of nothing to fill

}  // namespace

double RingFilling::triangle_quality(const TetMesh& mesh, int i, int j, int k, double floor) const {
  const LocalIndex a = _ring[i], b = _ring[j], c = _ring[k];
  const double upper = mesh.quality_of({a, b, c, _end});
  return upper > floor ? std::min(upper, mesh.quality_of({c, b, a, _start})) : upper;
}

double RingFilling::solve(const TetMesh& mesh, LocalIndex start, LocalIndex end,
                          std::span<const LocalIndex> ring, double floor) {
  _start = start;
  _end = end;
  _ring = ring;
  const int size = static_cast<int>(ring.size());
  for (int i = 0; i + 1 < size; ++i) _best[i][i + 1] = {perfect, -1};
  for (int length = 2; length < size; ++length) {
    for (int i = 0; i + length < size; ++i) {
      const int k = i + length;
      Choice best{-1, -1};
      for (int j = i + 1; j < k; ++j) {
        const double sides = std::min(_best[i][j].quality, _best[j][k].quality);
        if (sides <= std::max(floor, best.quality)) continue;
        const double quality = std::min(sides, triangle_quality(mesh, i, j, k, floor));
        if (quality > best.quality) best = {quality, j};
      }
      _best[i][k] = best;
    }
  }
  return _best[0][size - 1].quality;
}

void RingFilling::emit(std::vector<Corners>& tets) const {
  emit(0, static_cast<int>(_ring.size()) - 1, tets);
}

void RingFilling::emit(int i, int k, std::vector<Corners>& tets) const {
  if (k - i < 2) return;
  const int j = _best[i][k].apex;
  const LocalIndex a = _ring[i], b = _ring[j], c = _ring[k];
  tets.push_back({a, b, c, _end});
  tets.push_back({c, b, a, _start});
  emit(i, j, tets);
  emit(j, k, tets);
}

}  // namespace aeroloom::improve
