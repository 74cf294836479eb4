/// Boundary triangles that fill a strip of a CAD face between two curves in one go, because the curves are
/// closer than the elements along them.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <vector>

namespace aeroloom::attribution {

/// A triangle is one of a strip when its height over a side on one curve is at most this fraction of that
/// side. Chosen, not measured.
inline constexpr double strip_fraction = 0.4;

struct StripTriangle {
  mesh::LocalIndex triangle = 0;            ///< among the boundary triangles of its piece
  std::array<mesh::LocalIndex, 3> corners;  ///< two on one curve of the face, then one on another
  double width = 0;                         ///< height over the first two
};

/// Per piece of this rank the boundary triangles with two vertices on one curve and the third on another that
/// has neither of them and runs along, and a height of `strip_fraction` at most. Which curves meet at a CAD
/// vertex is read off the mesh: a curve is where triangles of two CAD faces meet. Collective.
std::vector<std::vector<StripTriangle>> find_strip_triangles(const mesh::DistributedMesh& mesh,
                                                             const mesh::Numbering& numbering);

}  // namespace aeroloom::attribution
