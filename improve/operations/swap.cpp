#include "improve/operations/swap.hpp"

#include <algorithm>
#include <array>

namespace aeroloom::improve {
namespace {

/// The edges of a tetrahedron by their dihedral angles, largest first: those whose removal promises most.
std::array<int, 6> widest_first(const TetMesh& mesh, LocalIndex t) {
  const Corners& c = mesh.corners(t);
  Vec3 normals[4];
  for (int f = 0; f < 4; ++f) {
    const auto& face = mesh::tetrahedron_faces[f];
    const Vec3 a = mesh.point(c[face[0]]);
    normals[f] = normalized(cross(mesh.point(c[face[1]]) - a, mesh.point(c[face[2]]) - a));
  }
  std::array<double, 6> cosine{};  // of the angle between outward normals: large where the dihedral is
  std::array<int, 6> order{};
  for (int e = 0; e < 6; ++e) {
    // The faces at an edge are opposite to the other two vertices.
    const auto& other = mesh::tetrahedron_edges[5 - e];
    cosine[e] = dot(normals[other[0]], normals[other[1]]);
    order[e] = e;
  }
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return cosine[a] != cosine[b] ? cosine[a] > cosine[b] : a < b; });
  return order;
}

}  // namespace

bool Swap::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  _best.clear();
  const double least = mesh.quality(t);
  const double enough = mesh.measure().target();
  for (const int edge : widest_first(mesh, t)) {
    const double floor = std::max(least, _best.after);
    if (_edge_removal.propose(mesh, t, edge, floor, _trial) ||
        _boundary_flip.propose(mesh, t, edge, floor, _trial)) {
      std::swap(_best, _trial);
    }
    if (_best.after >= enough) break;
  }
  for (int face = 0; face < 4 && _best.after < enough; ++face) {
    if (_face_removal.propose(mesh, t, face, std::max(least, _best.after), _trial)) std::swap(_best, _trial);
  }
  return _best.improves() && context.apply(_best);
}

}  // namespace aeroloom::improve
