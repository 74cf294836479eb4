#include "mesh/cavity_shares.hpp"

#include "mesh/tet_faces.hpp"

#include <algorithm>
#include <stdexcept>

namespace aeroloom::mesh {
CavityShares share_out(const Cavity& cavity, const std::vector<PieceId>& giver, const Refilling& refilling) {
  // The same faces, with the old and the new tetrahedron behind them.
  const std::vector<TetFace> given = boundary_faces(cavity.tets);
  std::vector<TetFace> taken;
  std::vector<std::array<std::int32_t, 4>> across(refilling.tets.size(), {-1, -1, -1, -1});
  const auto link = [&](std::int32_t from, std::int32_t to) {
    *std::find(across[from].begin(), across[from].end(), -1) = to;
  };
  for_each_face(
      sorted_faces(refilling.tets), [&](std::int32_t a, std::int32_t b) { link(a, b), link(b, a); },
      [&](const TetFace& face) { taken.push_back(face); });
  if (given.size() != taken.size()) throw std::logic_error("share_out: the refilling has another boundary");
  CavityShares shares;
  shares.of_tet.assign(refilling.tets.size(), -1);
  std::vector<std::int32_t> front;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (given[i].key != taken[i].key) throw std::logic_error("share_out: the refilling has another boundary");
    if (shares.of_tet[taken[i].tet] >= 0) continue;
    shares.of_tet[taken[i].tet] = giver[given[i].tet];
    front.push_back(taken[i].tet);
  }
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (const std::int32_t next : across[front[i]]) {
      if (next < 0 || shares.of_tet[next] >= 0) continue;
      shares.of_tet[next] = shares.of_tet[front[i]];
      front.push_back(next);
    }
  }
  for (const CavityTriangle& triangle : cavity.triangles) {
    auto wanted = triangle.vertices;
    std::sort(wanted.begin(), wanted.end());
    const auto at = std::lower_bound(taken.begin(), taken.end(), wanted,
                                     [](const TetFace& face, const auto& key) { return face.key < key; });
    if (at == taken.end() || at->key != wanted)
      throw std::logic_error("share_out: a triangle of the surface is not on the cavity's boundary");
    shares.of_triangle.push_back(shares.of_tet[at->tet]);
  }
  return shares;
}

}  // namespace aeroloom::mesh
