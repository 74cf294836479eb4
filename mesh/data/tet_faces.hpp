/// The faces of a set of tetrahedra: those between two of them, and those on its boundary.
#pragma once

#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// One side of a face.
struct TetFace {
  std::array<LocalIndex, 3> key;       ///< its vertices, ascending
  std::array<LocalIndex, 3> vertices;  ///< counter-clockwise seen from outside the tetrahedron
  std::int32_t tet;
};

/// All sides of all faces, by key, then by tetrahedron.
std::vector<TetFace> sorted_faces(const std::vector<std::array<LocalIndex, 4>>& tets);

/// Calls inner(a, b) for the two tetrahedra at each inner face and outer(face) for each on the boundary, in
/// the order of their keys. At most two tetrahedra share a face.
template <class Inner, class Outer>
void for_each_face(const std::vector<TetFace>& sorted, const Inner& inner, const Outer& outer) {
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i + 1 < sorted.size() && sorted[i].key == sorted[i + 1].key) {
      inner(sorted[i].tet, sorted[i + 1].tet);
      ++i;
    } else {
      outer(sorted[i]);
    }
  }
}

/// The faces on the boundary, by key.
std::vector<TetFace> boundary_faces(const std::vector<std::array<LocalIndex, 4>>& tets);

}  // namespace aeroloom::mesh
