#include "improve/edge_removal.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {

bool EdgeRemoval::propose(const TetMesh& mesh, LocalIndex t, int edge, double floor, Cavity& cavity) {
  if (!mesh.collect_shell(t, edge, largest_ring, _shell) || _shell.ring.size() < 3) return false;
  double before = std::numeric_limits<double>::max();
  for (const LocalIndex tet : _shell.tets) before = std::min(before, mesh.quality(tet));
  floor = std::max(floor, before);
  const double after = _filling.solve(mesh, _shell.start, _shell.end, _shell.ring, floor);
  if (after <= floor) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _shell.tets;
  _filling.emit(cavity.new_tets);
  return true;
}

}  // namespace aeroloom::improve
