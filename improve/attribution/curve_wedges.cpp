#include "improve/attribution/curve_wedges.hpp"

#include "geometry/angle.hpp"
#include "mesh/data/cad_dimension.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace aeroloom::attribution {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

/// What one piece knows of an edge.
struct PieceEdge {
  std::int64_t edge, piece;
  double angle;                       ///< degrees that its tetrahedra enclose
  std::array<std::int32_t, 2> faces;  ///< CAD faces of its boundary triangles there, -1 for none
};

double dihedral_at(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 axis = b - a;
  const Vec3 left = cross(axis, c - a), right = cross(axis, d - a);
  return geometry::degrees_per_radian * angle_between(left, right);
}

void add_face(std::array<std::int32_t, 2>& faces, std::int32_t face) {
  if (face < 0 || faces[0] == face || faces[1] == face) return;
  (faces[0] < 0 ? faces[0] : faces[1]) = face;
  if (faces[1] >= 0 && faces[0] > faces[1]) std::swap(faces[0], faces[1]);
}

void measure_edges(const Piece& piece, const std::vector<GlobalIndex>& names,
                   const std::vector<EdgeName>& edges, std::vector<PieceEdge>& rows) {
  std::vector<PieceEdge> mine;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    int curved = 0;
    for (int k = 0; k < 4; ++k) curved += is_on_curve(piece.vertex_dimension[c[k]]);
    if (curved < 2) continue;
    for (int e = 0; e < 6; ++e) {
      const auto& [a, b] = mesh::tetrahedron_edges[e];
      if (!is_on_curve(piece.vertex_dimension[c[a]]) || !is_on_curve(piece.vertex_dimension[c[b]])) continue;
      const std::int64_t edge = find_edge(edges, name_edge(piece, names, c[a], c[b]));
      if (edge < 0) continue;
      const auto& [u, v] = mesh::tetrahedron_edges[5 - e];
      const double angle =
          dihedral_at(piece.point(c[a]), piece.point(c[b]), piece.point(c[u]), piece.point(c[v]));
      mine.push_back({edge, piece.id, angle, {-1, -1}});
    }
  }
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    for (int k = 0; k < 3; ++k) {
      const LocalIndex a = v[k], b = v[(k + 1) % 3];
      if (!is_on_curve(piece.vertex_dimension[a]) || !is_on_curve(piece.vertex_dimension[b])) continue;
      const std::int64_t edge = find_edge(edges, name_edge(piece, names, a, b));
      if (edge >= 0) mine.push_back({edge, piece.id, 0, {piece.triangle_face[t], -1}});
    }
  }
  // One record per edge.
  std::stable_sort(mine.begin(), mine.end(),
                   [](const PieceEdge& a, const PieceEdge& b) { return a.edge < b.edge; });
  for (const PieceEdge& row : mine) {
    if (rows.empty() || rows.back().edge != row.edge || rows.back().piece != row.piece) {
      rows.push_back(row);
      continue;
    }
    rows.back().angle += row.angle;
    add_face(rows.back().faces, row.faces[0]);
  }
}

}  // namespace

EdgeName name_edge(const Piece& piece, const std::vector<GlobalIndex>& names, LocalIndex a, LocalIndex b) {
  return {std::min(names[a], names[b]), std::max(names[a], names[b]), piece.region};
}

std::int64_t find_edge(const std::vector<EdgeName>& edges, const EdgeName& edge) {
  const auto found = std::lower_bound(edges.begin(), edges.end(), edge);
  return found != edges.end() && *found == edge ? found - edges.begin() : -1;
}

std::vector<EdgeWedge> measure_wedges(const mesh::NumberedMesh& mesh, const std::vector<EdgeName>& edges) {
  std::vector<PieceEdge> mine;
  if (!edges.empty()) {
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
      measure_edges(mesh.pieces[i], mesh.numbering.vertices[i], edges, mine);
  }
  const std::vector<PieceEdge> all = mesh.communicator.gather_sorted(
      mine, [](const PieceEdge& each) { return std::tie(each.edge, each.piece); });
  std::vector<EdgeWedge> wedges(edges.size());
  for (const PieceEdge& row : all) {
    wedges[row.edge].angle += row.angle;
    for (const std::int32_t face : row.faces) add_face(wedges[row.edge].faces, face);
  }
  return wedges;
}

}  // namespace aeroloom::attribution
