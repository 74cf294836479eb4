#include "improve/attribution/curve_edges.hpp"

#include "geometry/sort_unique.hpp"

#include <algorithm>

namespace aeroloom::attribution {

using mesh::GlobalIndex;
using mesh::LocalIndex;

EdgeEnds ends_of(const std::vector<GlobalIndex>& names, LocalIndex a, LocalIndex b) {
  return {std::min(names[a], names[b]), std::max(names[a], names[b])};
}

CurveEdges::CurveEdges(const mesh::NumberedMesh& mesh, std::vector<EdgeEnds> asked) {
  geometry::sort_unique(asked);
  _asked = mesh.communicator.all_gather_items<EdgeEnds>(asked);
  geometry::sort_unique(_asked);
  using EdgeOfFace = std::array<std::int64_t, 2>;  // number of the edge, CAD face
  std::vector<EdgeOfFace> sides;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const mesh::Piece& piece = mesh.pieces[i];
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      for (int k = 0; k < 3; ++k) {
        const std::int64_t edge = find(ends_of(mesh.numbering.vertices[i], v[k], v[(k + 1) % 3]));
        if (edge >= 0) sides.push_back({edge, piece.triangle_face[t]});
      }
    }
  }
  geometry::sort_unique(sides);
  sides = mesh.communicator.all_gather_items<EdgeOfFace>(sides);
  geometry::sort_unique(sides);
  _is_on_curve.assign(_asked.size(), 0);
  for (std::size_t k = 1; k < sides.size(); ++k)
    if (sides[k][0] == sides[k - 1][0]) _is_on_curve[sides[k][0]] = 1;
}

bool CurveEdges::has(const EdgeEnds& edge) const {
  const std::int64_t number = find(edge);
  return number >= 0 && _is_on_curve[number] != 0;
}

std::int64_t CurveEdges::find(const EdgeEnds& edge) const {
  const auto found = std::lower_bound(_asked.begin(), _asked.end(), edge);
  return found != _asked.end() && *found == edge ? found - _asked.begin() : -1;
}

}  // namespace aeroloom::attribution
