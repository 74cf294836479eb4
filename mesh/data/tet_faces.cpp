#include "mesh/data/tet_faces.hpp"

#include "geometry/sort_by_number.hpp"

#include <algorithm>

namespace aeroloom::mesh {

std::vector<TetFace> sorted_faces(const std::vector<std::array<LocalIndex, 4>>& tets) {
  std::vector<TetFace> faces;
  faces.reserve(4 * tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const auto& f : tetrahedron_faces) {
      TetFace& face = faces.emplace_back();
      face.vertices = {tets[t][f[0]], tets[t][f[1]], tets[t][f[2]]};
      face.key = face.vertices;
      face.tet = static_cast<std::int32_t>(t);
      std::sort(face.key.begin(), face.key.end());
    }
  }
  geometry::sort_by_number(
      faces, [](const TetFace& face) { return face.key[0]; },
      [](const TetFace& a, const TetFace& b) { return a.key != b.key ? a.key < b.key : a.tet < b.tet; });
  return faces;
}

std::vector<TetFace> boundary_faces(const std::vector<std::array<LocalIndex, 4>>& tets) {
  std::vector<TetFace> faces;
  for_each_face(
      sorted_faces(tets), [](std::int32_t, std::int32_t) {},
      [&](const TetFace& face) { faces.push_back(face); });
  return faces;
}

}  // namespace aeroloom::mesh
