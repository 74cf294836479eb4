#include "improve/cavity_improver.hpp"

#include "improve/relaxation.hpp"
#include "improve/tet_quality.hpp"
#include "mesh/quality.hpp"
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
      const std::array<Vec3, 4> p{piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
      if (measure(p[0], p[1], p[2], p[3]) >= measure.target()) continue;
      ++count;
      const mesh::CavityId id =
          mesh::cavity_at(0.25 * (p[0] + p[1] + p[2] + p[3]), mean_edge(p), cell_width, shift);
      for (int k = 0; k < 4; ++k) mine[v[k]] = std::max(mine[v[k]], id);
    }
  }
  return count;
}

std::int64_t wish_for_borders(const mesh::DistributedMesh& mesh, int shift, mesh::CavityWishes& wishes) {
  std::int64_t count = 0;
  wishes.clear();
  std::vector<double> edges;
  std::vector<double> ratios;
  std::vector<std::int32_t> tets;
  for (const Piece& piece : mesh.pieces) {
    std::vector<mesh::CavityId>& mine = wishes.emplace_back(piece.vertex_count(), mesh::no_cavity);
    std::vector<LocalIndex> place(piece.vertex_count(), -1);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
      place[piece.shared_vertices[s]] = static_cast<LocalIndex>(s);
    edges.assign(piece.shared_vertices.size(), 0);
    ratios.assign(piece.shared_vertices.size(), 0);
    tets.assign(piece.shared_vertices.size(), 0);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      if (place[v[0]] < 0 && place[v[1]] < 0 && place[v[2]] < 0 && place[v[3]] < 0) continue;
      const std::array<Vec3, 4> p{piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
      const double ratio = mesh::mean_ratio(p[0], p[1], p[2], p[3]);
      const double edge = mean_edge(p);
      for (int k = 0; k < 4; ++k) {
        if (place[v[k]] < 0) continue;
        edges[place[v[k]]] += edge;
        ratios[place[v[k]]] += ratio;
        ++tets[place[v[k]]];
      }
    }
    for (std::size_t s = 0; s < tets.size(); ++s) {
      const LocalIndex v = piece.shared_vertices[s];
      if (tets[s] == 0 || piece.vertex_dimension[v] < 3 || ratios[s] >= Relaxation::good_enough * tets[s])
        continue;
      if (shift > 0 && mesh::is_placed_by_last_round(mesh, piece.shared_tokens[s])) continue;
      mine[v] = mesh::cavity_at(piece.point(v), edges[s] / tets[s], cell_width, shift);
      ++count;
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
