#include "improve/edge_removal.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {

double EdgeRemoval::triangle_quality(const TetMesh& mesh, int i, int j, int k, double floor) const {
  const LocalIndex a = _shell.ring[i], b = _shell.ring[j], c = _shell.ring[k];
  const double upper = mesh.quality_of({a, b, c, _shell.end});
  return upper > floor ? std::min(upper, mesh.quality_of({c, b, a, _shell.start})) : upper;
}

void EdgeRemoval::emit_triangles(int i, int k, Cavity& cavity) const {
  if (k - i < 2) return;
  const int j = _best[i][k].apex;
  const LocalIndex a = _shell.ring[i], b = _shell.ring[j], c = _shell.ring[k];
  cavity.new_tets.push_back({a, b, c, _shell.end});
  cavity.new_tets.push_back({c, b, a, _shell.start});
  emit_triangles(i, j, cavity);
  emit_triangles(j, k, cavity);
}

bool EdgeRemoval::propose(const TetMesh& mesh, LocalIndex t, int edge, double floor, Cavity& cavity) {
  if (!mesh.collect_shell(t, edge, largest_ring, _shell)) return false;
  const int size = static_cast<int>(_shell.ring.size());
  if (size < 3) return false;
  double before = std::numeric_limits<double>::max();
  for (const LocalIndex tet : _shell.tets) before = std::min(before, mesh.quality(tet));
  floor = std::max(floor, before);
  for (int i = 0; i + 1 < size; ++i) _best[i][i + 1] = {std::numeric_limits<double>::max(), -1};
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
  const double after = _best[0][size - 1].quality;
  if (after <= floor) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _shell.tets;
  emit_triangles(0, size - 1, cavity);
  return true;
}

}  // namespace aeroloom::improve
