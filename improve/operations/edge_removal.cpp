#include "improve/operations/edge_removal.hpp"

#include <algorithm>

namespace aeroloom::improve {

bool EdgeRemoval::propose(const TetMesh& mesh, LocalIndex t, int edge, double floor,
                          CavityReplacement& cavity) {
  if (!mesh.collect_edge_ring(t, edge, largest_ring, _edge_ring) || _edge_ring.ring.size() < 3) return false;
  const double before = mesh.worst_of(_edge_ring.tets);
  floor = std::max(floor, before);
  const double after = _filling.solve(mesh, _edge_ring.start, _edge_ring.end, _edge_ring.ring, floor);
  if (after <= floor) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _edge_ring.tets;
  _filling.emit(cavity.new_tets);
  return true;
}

}  // namespace aeroloom::improve
