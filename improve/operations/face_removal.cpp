#include "improve/operations/face_removal.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {

bool FaceRemoval::find_neighbour(const TetMesh& mesh, const FaceTets& from, LocalIndex u, LocalIndex v,
                                 FaceTets& next, LocalIndex& apex) const {
  LocalIndex third = -1;
  for (const LocalIndex w : mesh.corners(from.below)) {
    if (w != u && w != v && w != _below) third = w;
  }
  const HalfFace below = mesh.twin(4 * from.below + mesh.local_vertex(from.below, third));
  const HalfFace above = mesh.twin(4 * from.above + mesh.local_vertex(from.above, third));
  if (below < 0 || above < 0) return false;
  next = {below >> 2, above >> 2};
  apex = mesh.corners(next.below)[below & 3];
  const HalfFace through = mesh.twin(4 * next.below + mesh.local_vertex(next.below, _below));
  if (through < 0 || through >> 2 != next.above || mesh.corners(next.above)[above & 3] != apex) return false;
  // Growth around a vertex must not meet itself.
  return std::none_of(_faces.begin(), _faces.end(), [&](const FaceTets& s) { return s.below == next.below; });
}

double FaceRemoval::grow(const TetMesh& mesh, const FaceTets& from, LocalIndex u, LocalIndex v, int depth) {
  const double own = mesh.quality_of({_below, _above, u, v});
  FaceTets next{};
  LocalIndex apex = -1;
  if (own < mesh.measure().target() && depth < growth_depth && find_neighbour(mesh, from, u, v, next, apex)) {
    const std::size_t faces = _faces.size(), ring = _ring.size();
    _faces.push_back(next);
    double grown = grow(mesh, next, u, apex, depth + 1);
    if (grown > own) grown = std::min(grown, grow(mesh, next, apex, v, depth + 1));
    if (grown > own) return grown;
    _faces.resize(faces);
    _ring.resize(ring);
  }
  _ring.push_back({u, v});
  return own;
}

bool FaceRemoval::propose(const TetMesh& mesh, LocalIndex t, int face, double floor,
                          CavityReplacement& cavity) {
  const HalfFace other = mesh.twin(4 * t + face);
  if (other < 0) return false;
  _below = mesh.corners(t)[face];
  _above = mesh.corners(other >> 2)[other & 3];
  const FaceTets first{t, other >> 2};
  _faces.assign(1, first);
  _ring.clear();
  double after = std::numeric_limits<double>::max();
  for (int i = 0; i < 3 && after > floor; ++i) {
    const auto& corner = mesh::tetrahedron_faces[face];
    after = std::min(after,
                     grow(mesh, first, mesh.corners(t)[corner[i]], mesh.corners(t)[corner[(i + 1) % 3]], 0));
  }
  double before = std::numeric_limits<double>::max();
  for (const FaceTets& s : _faces) before = std::min({before, mesh.quality(s.below), mesh.quality(s.above)});
  if (after <= std::max(floor, before)) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  for (const FaceTets& s : _faces) cavity.old_tets.insert(cavity.old_tets.end(), {s.below, s.above});
  for (const auto& [u, v] : _ring) cavity.new_tets.push_back({_below, _above, u, v});
  return true;
}

}  // namespace aeroloom::improve
