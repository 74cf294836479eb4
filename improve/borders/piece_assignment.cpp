#include "improve/borders/piece_assignment.hpp"

#include "mesh/data/tet_faces.hpp"

#include <algorithm>
#include <stdexcept>

namespace aeroloom::cavities {
namespace {

const mesh::TetFace* find_face(const std::vector<mesh::TetFace>& faces,
                               std::array<mesh::LocalIndex, 3> vertices) {
  std::sort(vertices.begin(), vertices.end());
  const auto at = std::lower_bound(faces.begin(), faces.end(), vertices,
                                   [](const mesh::TetFace& face, const auto& key) { return face.key < key; });
  return at != faces.end() && at->key == vertices ? &*at : nullptr;
}

}  // namespace

CavityAssignment assign_to_pieces(const Cavity& cavity, const std::vector<mesh::PieceId>& donor,
                                  const CavityContent& content) {
  // Boundary faces of the cavity, with the old and the new tetrahedron inside them.
  const std::vector<mesh::TetFace> given = mesh::boundary_faces(cavity.tets);
  std::vector<mesh::TetFace> taken;
  std::vector<std::array<std::int32_t, 4>> across(content.tets.size(), {-1, -1, -1, -1});
  const auto link = [&](std::int32_t from, std::int32_t to) {
    *std::find(across[from].begin(), across[from].end(), -1) = to;
  };
  mesh::for_each_face(
      mesh::sorted_faces(content.tets), [&](std::int32_t a, std::int32_t b) { link(a, b), link(b, a); },
      [&](const mesh::TetFace& face) { taken.push_back(face); });
  // Faces that differ are triangles of the surface mesh, on either side.
  std::size_t kept = 0;
  CavityAssignment assignment;
  assignment.of_tet.assign(content.tets.size(), -1);
  std::vector<std::int32_t> front;
  for (const mesh::TetFace& face : taken) {
    const mesh::TetFace* old = find_face(given, face.key);
    if (!old) continue;
    ++kept;
    if (assignment.of_tet[face.tet] >= 0) continue;
    assignment.of_tet[face.tet] = donor[old->tet];
    front.push_back(face.tet);
  }
  const std::vector<CavityTriangle>& triangles = content.triangles_of(cavity);
  const auto count_new = [](const std::vector<CavityTriangle>& of, const std::vector<mesh::TetFace>& other) {
    return static_cast<std::size_t>(std::count_if(
        of.begin(), of.end(), [&](const CavityTriangle& t) { return !find_face(other, t.vertices); }));
  };
  if (taken.size() - kept != count_new(triangles, given) ||
      given.size() - kept != count_new(cavity.triangles, taken)) {
    throw std::logic_error("assign_to_pieces: the content has another boundary");
  }
  if (front.empty()) {  // nothing is left of the boundary of a whole region
    assignment.of_tet[0] = *std::min_element(donor.begin(), donor.end());
    front.push_back(0);
  }
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (const std::int32_t next : across[front[i]]) {
      if (next < 0 || assignment.of_tet[next] >= 0) continue;
      assignment.of_tet[next] = assignment.of_tet[front[i]];
      front.push_back(next);
    }
  }
  for (const CavityTriangle& triangle : triangles) {
    const mesh::TetFace* face = find_face(taken, triangle.vertices);
    if (!face)
      throw std::logic_error("assign_to_pieces: a triangle of the surface is not on the cavity's boundary");
    assignment.of_triangle.push_back(assignment.of_tet[face->tet]);
  }
  return assignment;
}

}  // namespace aeroloom::cavities
