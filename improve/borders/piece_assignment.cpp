#include "improve/borders/piece_assignment.hpp"

#include "mesh/data/tet_faces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace aeroloom::cavities {
namespace {

using FaceVertices = std::array<mesh::LocalIndex, 3>;

bool have_same_orientation(const FaceVertices& a, const FaceVertices& b) {
  const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[(at + 1) % 3] == a[1];
}

/// A baffle triangle has two faces, one for each side.
const mesh::TetFace* find_face(const std::vector<mesh::TetFace>& faces, const FaceVertices& wanted) {
  FaceVertices key = wanted;
  std::sort(key.begin(), key.end());
  auto at = std::lower_bound(faces.begin(), faces.end(), key,
                             [](const mesh::TetFace& face, const auto& k) { return face.key < k; });
  if (at == faces.end() || at->key != key) return nullptr;
  const auto next = at + 1;
  if (next != faces.end() && next->key == key && !have_same_orientation(wanted, at->vertices)) at = next;
  return &*at;
}

/// The faces of tetrahedra on the boundary, and both sides of the triangles between two; calls inner(a, b)
/// for the other faces.
template <class Inner>
std::vector<mesh::TetFace> outer_faces(const std::vector<std::array<mesh::LocalIndex, 4>>& tets,
                                       const std::vector<CavityTriangle>& triangles, const Inner& inner) {
  std::vector<FaceVertices> keys;
  keys.reserve(triangles.size());
  for (const CavityTriangle& t : triangles) {
    keys.push_back(t.vertices);
    std::sort(keys.back().begin(), keys.back().end());
  }
  std::sort(keys.begin(), keys.end());
  const std::vector<mesh::TetFace> faces = mesh::sorted_faces(tets);
  std::vector<mesh::TetFace> outer;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool is_pair = i + 1 < faces.size() && faces[i].key == faces[i + 1].key;
    if (is_pair && !std::binary_search(keys.begin(), keys.end(), faces[i].key)) {
      inner(faces[i].tet, faces[i + 1].tet);
      ++i;
    } else {
      outer.push_back(faces[i]);
    }
  }
  return outer;
}

}  // namespace

CavityAssignment assign_to_pieces(const Cavity& cavity, const std::vector<mesh::PieceId>& donor,
                                  const CavityContent& content) {
  // Boundary faces of the cavity, with the old and the new tetrahedron inside them.
  const std::vector<mesh::TetFace> given =
      outer_faces(cavity.tets, cavity.triangles, [](std::int32_t, std::int32_t) {});
  std::vector<std::array<std::int32_t, 4>> across(content.tets.size(), {-1, -1, -1, -1});
  const auto link = [&](std::int32_t from, std::int32_t to) {
    *std::find(across[from].begin(), across[from].end(), -1) = to;
  };
  const std::vector<CavityTriangle>& triangles = content.triangles_of(cavity);
  const std::vector<mesh::TetFace> taken =
      outer_faces(content.tets, triangles, [&](std::int32_t a, std::int32_t b) { link(a, b), link(b, a); });
  // Faces that differ are triangles of the surface mesh, on either side.
  std::size_t kept = 0;
  CavityAssignment assignment;
  assignment.of_tet.assign(content.tets.size(), -1);
  std::vector<std::int32_t> front;
  for (const mesh::TetFace& face : taken) {
    const mesh::TetFace* old = find_face(given, face.vertices);
    if (!old) continue;
    ++kept;
    if (assignment.of_tet[face.tet] >= 0) continue;
    assignment.of_tet[face.tet] = donor[old->tet];
    front.push_back(face.tet);
  }
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
