#include "improve/cavity_improver.hpp"

#include "improve/tet_quality.hpp"
#include "mesh/tet_faces.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// Width of the grid's cells, in edges of the bad tetrahedron in them, at least.
constexpr double cell_width = 8;

/// Vertices on the boundary of the cavity first: these stay as they are.
std::vector<LocalIndex> boundary_first(const mesh::Cavity& cavity, std::size_t& on_boundary) {
  std::vector<char> outer(cavity.points.size(), 0);
  for (const mesh::TetFace& face : mesh::boundary_faces(cavity.tets)) {
    for (const LocalIndex v : face.vertices) outer[v] = 1;
  }
  std::vector<LocalIndex> order;
  for (const char wanted : {1, 0}) {
    for (std::size_t v = 0; v < outer.size(); ++v) {
      if (outer[v] == wanted) order.push_back(static_cast<LocalIndex>(v));
    }
    if (wanted) on_boundary = order.size();
  }
  return order;
}

}  // namespace

std::int64_t wish_for_bad(const mesh::DistributedMesh& mesh, const ImproveOptions& options, int shift,
                          mesh::CavityWishes& wishes) {
  const TetQuality measure(options.target_angle);
  std::int64_t count = 0;
  wishes.clear();
  for (const Piece& piece : mesh.pieces) {
    std::vector<mesh::CavityId>& mine = wishes.emplace_back(piece.vertex_count(), mesh::no_cavity);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      const Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
      if (measure(p[0], p[1], p[2], p[3]) >= measure.target()) continue;
      ++count;
      double edges = 0;
      for (const auto& [i, j] : mesh::tetrahedron_edges) edges += distance(p[i], p[j]) / 6;
      const mesh::CavityId id = mesh::cavity_at(0.25 * (p[0] + p[1] + p[2] + p[3]), edges, cell_width, shift);
      for (int k = 0; k < 4; ++k) mine[v[k]] = std::max(mine[v[k]], id);
    }
  }
  return count;
}

std::optional<mesh::Refilling> improve_cavity(const mesh::Cavity& cavity, const ImproveOptions& options,
                                              ImproveReport& report) {
  std::size_t fixed = 0;
  const std::vector<LocalIndex> order = boundary_first(cavity, fixed);
  std::vector<LocalIndex> number(order.size());
  Piece piece;
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[order[i]] = static_cast<LocalIndex>(i);
    const Vec3 p = cavity.points[order[i]];
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    piece.vertex_dimension.push_back(cavity.dimension[order[i]]);
    piece.vertex_entity.push_back(0);
  }
  for (const auto& tet : cavity.tets) {
    for (const LocalIndex v : tet) piece.cells.push_back(number[v]);
  }
  const ImproveReport mine = improve_piece(piece, options);
  report.smoothed += mine.smoothed;
  report.swaps += mine.swaps;
  if (mine.smoothed + mine.swaps == 0) return std::nullopt;
  mesh::Refilling result;
  for (auto v = static_cast<LocalIndex>(fixed); v < piece.vertex_count(); ++v)
    result.added.push_back(piece.point(v));
  const auto known = static_cast<LocalIndex>(order.size());
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    auto& tet = result.tets.emplace_back();
    for (int k = 0; k < 4; ++k) {
      const LocalIndex v = piece.cell(t)[k];
      tet[k] = v < static_cast<LocalIndex>(fixed) ? order[v] : known + (v - static_cast<LocalIndex>(fixed));
    }
  }
  return result;
}

}  // namespace aeroloom::improve
