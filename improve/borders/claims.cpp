#include "improve/borders/claims.hpp"

#include "mesh/data/mixing.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::cavities {
namespace {

using geometry::Vec3;

/// 1 for vertices of tetrahedra that two cavities claim.
std::vector<char> find_contested(const mesh::Piece& piece, const std::vector<CavityId>& claims) {
  std::vector<char> contested(piece.vertex_count(), 0);
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    CavityId met = no_cavity;
    bool several = false;
    for (int k = 0; k < 4; ++k) {
      if (claims[v[k]] == no_cavity) continue;
      several = several || (met != no_cavity && met != claims[v[k]]);
      met = claims[v[k]];
    }
    for (int k = 0; several && k < 4; ++k) contested[v[k]] = 1;
  }
  return contested;
}

}  // namespace

CavityId cavity_at(Vec3 p, double size, double width, int shift) {
  // Offsets of the grid in cell widths, from halves and the golden section. They differ much in each
  // direction, so that few places are at borders twice.
  constexpr double step[3] = {0.5, 0.382, 0.618}, level_step = 0.38;
  const double level = std::floor(std::log2(width * size) / 3 + level_step * shift);
  const double edge = std::exp2(3 * (level + 1 - level_step * shift));
  const auto bits = [](double whole) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole)); };
  std::uint64_t id = mesh::mix_in(static_cast<std::uint64_t>(shift), bits(level));
  for (int axis = 0; axis < 3; ++axis)
    id = mesh::mix_in(id, bits(std::floor(p[axis] / edge + shift * step[axis])));
  return id == no_cavity ? CavityId{1} : id;
}

void withdraw_contested_claims(const mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                               CavityClaims& claims) {
  std::vector<std::vector<char>> contested;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p)
    contested.push_back(find_contested(mesh.pieces[p], claims[p]));
  shared.combine(contested, [](char a, char b) { return static_cast<char>(a | b); });
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      if (contested[p][v]) claims[p][v] = no_cavity;
    }
  }
}

void widen(const mesh::Piece& piece, bool along_surface, std::vector<CavityId>& claims) {
  std::vector<char> barred(piece.vertex_count(), 0);
  for (const mesh::LocalIndex v : piece.shared_vertices) barred[v] = 1;
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if ((is_on_boundary(piece.vertex_dimension[v]) && !along_surface) || claims[v] != no_cavity)
      barred[v] = 1;
  }
  std::vector<CavityId> next(piece.vertex_count(), no_cavity);
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    const CavityId cavity = cavity_of(claims, v, 4);
    if (cavity == no_cavity) continue;
    for (int k = 0; k < 4; ++k) {
      if (barred[v[k]]) continue;
      if (next[v[k]] == no_cavity) next[v[k]] = cavity;
      if (next[v[k]] != cavity) barred[v[k]] = 1, next[v[k]] = no_cavity;
    }
  }
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    const CavityId now = cavity_of(claims, v, 4), cavity = cavity_of(next, v, 4);
    if (cavity == no_cavity) continue;
    for (int k = 0; k < 4; ++k) {
      const CavityId other = next[v[k]];
      if (other == no_cavity || (other == cavity && (now == no_cavity || now == other))) continue;
      for (int i = 0; i < 4; ++i) barred[v[i]] = 1;
    }
  }
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (!barred[v]) claims[v] = next[v];
  }
}

}  // namespace aeroloom::cavities
