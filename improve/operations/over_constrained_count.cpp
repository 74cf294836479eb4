#include "improve/operations/over_constrained_count.hpp"

#include <algorithm>
#include <iterator>

namespace aeroloom::improve {

int count_boundary_faces(const TetMesh& mesh, LocalIndex t) {
  int count = 0;
  for (int face = 0; face < 4; ++face) count += is_triangle(mesh.twin(4 * t + face)) ? 1 : 0;
  return count;
}

int OverConstrainedCount::added_by(const TetMesh& mesh, const CavityReplacement& cavity) {
  std::ptrdiff_t added = 0;
  _sides.clear();
  for (const LocalIndex t : cavity.old_tets) {
    if (count_boundary_faces(mesh, t) > 1) --added;
    const Corners& c = mesh.corners(t);
    for (int face = 0; face < 4; ++face) {
      const auto& corner = mesh::tetrahedron_faces[face];
      if (is_triangle(mesh.twin(4 * t + face)))
        _sides.push_back(sorted(c[corner[0]], c[corner[1]], c[corner[2]]));
    }
  }
  if (_sides.size() < 2) return static_cast<int>(added);
  const auto is_side = [&](const Corners& c, const auto& corner) {
    return std::find(_sides.begin(), _sides.end(), sorted(c[corner[0]], c[corner[1]], c[corner[2]])) !=
           _sides.end();
  };
  added += std::count_if(cavity.new_tets.begin(), cavity.new_tets.end(), [&](const Corners& c) {
    return std::count_if(std::begin(mesh::tetrahedron_faces), std::end(mesh::tetrahedron_faces),
                         [&](const auto& corner) { return is_side(c, corner); }) > 1;
  });
  return static_cast<int>(added);
}

}  // namespace aeroloom::improve
