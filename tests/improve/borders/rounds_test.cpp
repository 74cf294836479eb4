#include "improve/borders/rounds.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/data/tet_faces.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <gtest/gtest.h>

namespace aeroloom::cavities {
namespace {

using parallel::Communicator;

constexpr int squares = 6, pieces = 7;

/// Every shared vertex inside claims the cavity of its cell.
CavityClaims claim_for_shared(const mesh::DistributedMesh& mesh, int shift, double size = 0.3) {
  CavityClaims claims;
  for (const mesh::Piece& piece : mesh.pieces) {
    auto& mine = claims.emplace_back(piece.vertex_count(), no_cavity);
    for (const mesh::LocalIndex v : piece.shared_vertices) {
      if (piece.vertex_dimension[v] == mesh::CadDimension::region)
        mine[v] = cavity_at(piece.point(v), size, 1, shift);
    }
  }
  return claims;
}

/// The tetrahedra as they were.
std::optional<CavityContent> same(const Cavity& cavity) {
  return CavityContent{{}, cavity.tets, {}};
}

/// Each tetrahedron divided in four by a vertex in its middle.
std::optional<CavityContent> divided(const Cavity& cavity) {
  CavityContent result;
  auto next = static_cast<mesh::LocalIndex>(cavity.points.size());
  for (const auto& tet : cavity.tets) {
    geometry::Vec3 middle;
    for (const mesh::LocalIndex v : tet) middle += 0.25 * cavity.points[v];
    result.added.push_back({middle});
    for (int k = 0; k < 4; ++k) {
      auto part = tet;
      part[k] = next;
      result.tets.push_back(part);
    }
    ++next;
  }
  return result;
}

/// Vertices on faces of the cube that no other tetrahedra have move a little within their plane.
std::optional<CavityContent> slid(const Cavity& cavity) {
  std::vector<std::array<mesh::LocalIndex, 3>> open;
  for (const CavityTriangle& triangle : cavity.triangles) {
    open.push_back(triangle.vertices);
    std::sort(open.back().begin(), open.back().end());
  }
  std::vector<char> stays(cavity.points.size(), 0);
  for (const mesh::TetFace& face : mesh::boundary_faces(cavity.tets)) {
    if (std::find(open.begin(), open.end(), face.key) != open.end()) continue;
    for (const mesh::LocalIndex v : face.vertices) stays[v] = 1;
  }
  CavityContent result{{}, cavity.tets, cavity.triangles};
  std::vector<mesh::LocalIndex> named(cavity.points.size());
  for (std::size_t v = 0; v < named.size(); ++v) {
    named[v] = static_cast<mesh::LocalIndex>(v);
    if (stays[v] || cavity.dimension[v] != mesh::CadDimension::face) continue;
    geometry::Vec3 p = cavity.points[v];
    for (int axis = 0; axis < 3; ++axis) p[axis] += p[axis] > 0 && p[axis] < 1 ? 0.01 : 0;
    named[v] = static_cast<mesh::LocalIndex>(cavity.points.size() + result.added.size());
    result.added.push_back({p, mesh::CadDimension::face, cavity.entity[v]});
  }
  for (auto& tet : result.tets) {
    for (mesh::LocalIndex& v : tet) v = named[v];
  }
  for (CavityTriangle& triangle : *result.triangles) {
    for (mesh::LocalIndex& v : triangle.vertices) v = named[v];
  }
  return result;
}

mesh::GlobalIndex count_cells(const mesh::DistributedMesh& mesh) {
  return mesh::number_mesh(mesh).numbering.cell_count;
}

void expect_valid(const mesh::DistributedMesh& mesh) {
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  const mesh::ValidityReport report = mesh::check_volume_mesh(numbered, nullptr);
  EXPECT_TRUE(report.valid()) << (report.violations.empty() ? "" : report.violations.front());
  EXPECT_NEAR(report.volume, 1, 1e-12);
}

std::string hash(const mesh::DistributedMesh& mesh) {
  return mesh::hash_mesh(mesh::number_mesh(mesh));
}

CavityRound one_round(mesh::DistributedMesh& mesh, const CavityClaims& claims, CavityExtent extent,
                      const ReplaceCavity& replace) {
  const mesh::SharedVertices shared(mesh);
  return replace_cavities(mesh, shared, {claims, extent, replace});
}

TEST(Cavities, KeepTheMeshWhole) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = mesh::examples::cube(world, squares, pieces);
  const mesh::GlobalIndex cells = count_cells(mesh);
  for (int shift = 0; shift < 4; ++shift) {
    const CavityRound round = one_round(mesh, claim_for_shared(mesh, shift), {}, same);
    EXPECT_GT(round.cavities, 0);
    EXPECT_EQ(round.replaced, round.cavities);
    expect_valid(mesh);
    EXPECT_EQ(count_cells(mesh), cells);
  }
}

// Kept cells are where they were, the others new: told by their corners.
TEST(Cavities, SayWhatTheyChanged) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = mesh::examples::cube(world, 2 * squares, pieces);
  const auto corners = [](const mesh::Piece& piece, mesh::LocalIndex cell) {
    std::array<geometry::Vec3, 4> result;
    for (int k = 0; k < 4; ++k) result[k] = piece.point(piece.cell(cell)[k]);
    return result;
  };
  const std::vector<mesh::Piece> before = mesh.pieces;
  const CavityRound round = one_round(mesh, claim_for_shared(mesh, 0), {}, divided);
  ASSERT_EQ(round.changes.size(), before.size());
  std::int64_t changed = 0, kept = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const PieceChange& change = round.changes[p];
    std::vector<mesh::LocalIndex> cells;
    for (mesh::LocalIndex c = 0; c < before[p].cell_count(); ++c) {
      if (!std::binary_search(change.left.begin(), change.left.end(), c)) cells.push_back(c);
    }
    ASSERT_EQ(static_cast<std::size_t>(change.first_new), cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      EXPECT_EQ(corners(mesh.pieces[p], static_cast<mesh::LocalIndex>(i)), corners(before[p], cells[i]));
    changed += static_cast<std::int64_t>(change.left.size());
    kept += change.first_new;
    EXPECT_EQ(mesh.pieces[p].cell_count() > change.first_new, !change.left.empty());
  }
  EXPECT_GT(world.sum(changed), 0);
  EXPECT_GT(world.sum(kept), 0);
}

TEST(Cavities, ReachAsFarAsTheyAreTold) {
  const auto world = Communicator::world();
  std::vector<std::int64_t> taken, triangles;
  for (const CavityExtent reach : {CavityExtent{0, false}, {1, false}, {2, false}, {2, true}}) {
    mesh::DistributedMesh mesh = mesh::examples::cube(world, 2 * squares, pieces);
    std::int64_t tets = 0, on_surface = 0;
    const auto count = [&](const Cavity& cavity) {
      tets += static_cast<std::int64_t>(cavity.tets.size());
      on_surface += static_cast<std::int64_t>(cavity.triangles.size());
      return same(cavity);
    };
    // Far from each other, a cavity each.
    CavityClaims claims;
    for (const mesh::Piece& piece : mesh.pieces) {
      auto& mine = claims.emplace_back(piece.vertex_count(), no_cavity);
      for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const geometry::Vec3 p = piece.point(v);
        const auto at = [](double x, double place) { return std::abs(x - place) < 0.04; };
        if (at(p.x, 0.5) && at(p.y, 1.0 / 12) && (at(p.z, 0.25) || at(p.z, 0.75)))
          mine[v] = cavity_at(p, 0.3, 1, 0);
      }
    }
    one_round(mesh, claims, reach, count);
    expect_valid(mesh);
    taken.push_back(world.sum(tets));
    triangles.push_back(world.sum(on_surface));
  }
  for (std::size_t i = 1; i < taken.size(); ++i) EXPECT_GT(taken[i], taken[i - 1]) << i;
  EXPECT_GT(triangles[3], triangles[2]);
}

TEST(Cavities, TakeNewVertices) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = mesh::examples::cube(world, squares, pieces);
  const mesh::GlobalIndex cells = count_cells(mesh);
  std::int64_t taken = 0;
  one_round(mesh, claim_for_shared(mesh, 0), {}, [&](const Cavity& cavity) {
    taken += static_cast<std::int64_t>(cavity.tets.size());
    return divided(cavity);
  });
  expect_valid(mesh);
  EXPECT_EQ(count_cells(mesh), cells + 3 * world.sum(taken));
}

/// Every shared vertex on the surface claims the cavity of its cell.
CavityClaims claim_for_surface(const mesh::DistributedMesh& mesh) {
  CavityClaims claims;
  for (const mesh::Piece& piece : mesh.pieces) {
    auto& mine = claims.emplace_back(piece.vertex_count(), no_cavity);
    for (const mesh::LocalIndex v : piece.shared_vertices) mine[v] = cavity_at(piece.point(v), 0.3, 1, 0);
  }
  return claims;
}

std::int64_t count_moved(const mesh::DistributedMesh& mesh) {
  const Communicator& communicator = mesh.communicator;
  std::int64_t moved = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const double x = squares * piece.point(v).x, y = squares * piece.point(v).y;
      moved += piece.vertex_dimension[v] == mesh::CadDimension::face &&
               (std::abs(x - std::round(x)) > 0.01 || std::abs(y - std::round(y)) > 0.01);
    }
  }
  return communicator.sum(moved);
}

TEST(Cavities, MayChangeTheSurface) {
  const auto world = Communicator::world(), self = Communicator::self();
  mesh::DistributedMesh together = mesh::examples::cube(world, squares, pieces);
  mesh::DistributedMesh alone = mesh::examples::cube(self, squares, pieces);
  const mesh::MeshCounts before = mesh::count_mesh(mesh::number_mesh(together));
  EXPECT_EQ(count_moved(together), 0);
  one_round(together, claim_for_surface(together), {}, slid);
  one_round(alone, claim_for_surface(alone), {}, slid);
  expect_valid(together);
  const mesh::MeshCounts after = mesh::count_mesh(mesh::number_mesh(together));
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.cells, before.cells);
  EXPECT_EQ(after.boundary_triangles, before.boundary_triangles);
  EXPECT_GT(count_moved(together), 10);
  EXPECT_EQ(hash(together), hash(alone));
}

TEST(CavitiesLocal, RefuseAnotherBoundary) {
  const auto self = Communicator::self();
  mesh::DistributedMesh mesh = mesh::examples::cube(self, squares, pieces);
  const auto without_one = [](const Cavity& cavity) {
    CavityContent result{{}, cavity.tets, {}};
    result.tets.pop_back();
    return std::optional(result);
  };
  EXPECT_THROW(one_round(mesh, claim_for_shared(mesh, 0), {}, without_one), parallel::CollectiveError);
}

TEST(Cavities, AreTheSameForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  mesh::DistributedMesh together = mesh::examples::cube(world, squares, pieces);
  mesh::DistributedMesh alone = mesh::examples::cube(self, squares, pieces);
  for (int shift = 0; shift < 3; ++shift) {
    const auto replace = shift == 1 ? divided : same;
    const CavityExtent reach{shift, shift == 2};
    one_round(together, claim_for_shared(together, shift), reach, replace);
    one_round(alone, claim_for_shared(alone, shift), reach, replace);
  }
  EXPECT_EQ(hash(together), hash(alone));
}

TEST(Cavities, AreAssignedToRanksByTheirTetrahedra) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = mesh::examples::cube(world, 4 * squares, pieces);
  std::int64_t tets = 0, largest = 0;
  const auto count = [&](const Cavity& cavity) {
    tets += static_cast<std::int64_t>(cavity.tets.size());
    largest = std::max(largest, static_cast<std::int64_t>(cavity.tets.size()));
    return same(cavity);
  };
  one_round(mesh, claim_for_shared(mesh, 0, 0.03), {}, count);
  // The heaviest rank is above the mean by no more than one cavity.
  EXPECT_LE(world.maximum(tets), world.sum(tets) / world.size() + world.maximum(largest));
  EXPECT_GT(world.sum(tets), 2 * world.maximum(largest));
}

TEST(Cavities, ThatAreNotReplacedStay) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = mesh::examples::cube(world, squares, pieces);
  const std::string before = hash(mesh);
  const CavityRound round =
      one_round(mesh, claim_for_shared(mesh, 0), {}, [](const Cavity&) { return std::nullopt; });
  EXPECT_GT(round.cavities, 0);
  EXPECT_EQ(round.replaced, 0);
  EXPECT_EQ(hash(mesh), before);
}

TEST(CavityAtLocal, NamesTheSamePlaceAlike) {
  const geometry::Vec3 p{0.3, -1.7, 12.5};
  for (int shift = 0; shift < 6; ++shift) {
    EXPECT_EQ(cavity_at(p, 0.1, 8, shift), cavity_at(p + geometry::Vec3{1e-9, 0, 0}, 0.1, 8, shift));
    EXPECT_NE(cavity_at(p, 0.1, 8, shift), cavity_at(p + geometry::Vec3{100, 0, 0}, 0.1, 8, shift));
    EXPECT_NE(cavity_at(p, 0.1, 8, shift), no_cavity);
  }
}

}  // namespace
}  // namespace aeroloom::cavities
