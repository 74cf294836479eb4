#include "improve/operations/boundary_flip.hpp"

#include <algorithm>

namespace aeroloom::improve {

bool BoundaryFlip::keeps_boundary(TetMesh& mesh) {
  const auto [first, last] = _fan.triangles;
  if (!mesh.is_free_triangle(first) || !mesh.is_free_triangle(last) || !mesh.on_same_face(first, last))
    return false;
  const LocalIndex from = _fan.ring.front(), to = _fan.ring.back();
  const TrianglePoints before[] = {points_of(mesh, mesh.triangle(first)),
                                   points_of(mesh, mesh.triangle(last))};
  const TrianglePoints after[] = {points_of(mesh, {from, _fan.end, to}),
                                  points_of(mesh, {to, _fan.start, from})};
  if (!is_gentle_change(before, after) || _edges.exists(mesh, from, to)) return false;
  if (_fan.tets.size() > 1) return true;
  // The faces behind the only tetrahedron become the boundary.
  const LocalIndex t = _fan.tets[0];
  return mesh.twin(4 * t + mesh.local_vertex(t, _fan.start)) >= 0 &&
         mesh.twin(4 * t + mesh.local_vertex(t, _fan.end)) >= 0;
}

bool BoundaryFlip::propose(TetMesh& mesh, LocalIndex t, int edge, double floor, CavityReplacement& cavity) {
  if (!mesh.collect_fan(t, edge, RingFilling::largest_ring - 1, _fan)) return false;
  const double before = mesh.worst_of(_fan.tets);
  floor = std::max(floor, before);
  const double after = _filling.solve(mesh, _fan.start, _fan.end, _fan.ring, floor);
  if (after <= floor || !keeps_boundary(mesh)) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _fan.tets;
  cavity.old_triangles.assign(_fan.triangles.begin(), _fan.triangles.end());
  _filling.emit(cavity.new_tets);
  return true;
}

}  // namespace aeroloom::improve
