#include "mesh/cavity_shares.hpp"

#include <algorithm>
#include <stdexcept>

namespace aeroloom::mesh {
namespace {

struct TetFace {
  std::array<LocalIndex, 3> vertices;  // ascending
  std::int32_t tet;
};

std::array<LocalIndex, 3> ascending(std::array<LocalIndex, 3> v) {
  std::sort(v.begin(), v.end());
  return v;
}

bool less(const TetFace& a, const TetFace& b) {
  return a.vertices != b.vertices ? a.vertices < b.vertices : a.tet < b.tet;
}

std::vector<TetFace> sorted_faces(const std::vector<std::array<LocalIndex, 4>>& tets) {
  std::vector<TetFace> faces;
  faces.reserve(4 * tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const auto& f : tetrahedron_faces)
      faces.push_back(
          {ascending({tets[t][f[0]], tets[t][f[1]], tets[t][f[2]]}), static_cast<std::int32_t>(t)});
  }
  std::sort(faces.begin(), faces.end(), less);
  return faces;
}

/// Calls inner(a, b) for the two sides of each inner face and outer(face) for those on the boundary, in
/// order.
template <class Inner, class Outer>
void for_each_face(const std::vector<TetFace>& faces, const Inner& inner, const Outer& outer) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i + 1 < faces.size() && faces[i].vertices == faces[i + 1].vertices) {
      inner(faces[i].tet, faces[i + 1].tet);
      ++i;
    } else {
      outer(faces[i]);
    }
  }
}

}  // namespace

CavityShares share_out(const Cavity& cavity, const std::vector<PieceId>& giver, const Refilling& refilling) {
  const auto ignore = [](std::int32_t, std::int32_t) {};
  std::vector<TetFace> given, taken;  // the same faces, with the old and the new tetrahedron behind them
  for_each_face(sorted_faces(cavity.tets), ignore, [&](const TetFace& face) { given.push_back(face); });
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
    if (given[i].vertices != taken[i].vertices)
      throw std::logic_error("share_out: the refilling has another boundary");
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
    const TetFace wanted{ascending(triangle.vertices), -1};
    const auto at = std::lower_bound(taken.begin(), taken.end(), wanted, less);
    if (at == taken.end() || at->vertices != wanted.vertices)
      throw std::logic_error("share_out: a triangle of the surface is not on the cavity's boundary");
    shares.of_triangle.push_back(shares.of_tet[at->tet]);
  }
  return shares;
}

}  // namespace aeroloom::mesh
