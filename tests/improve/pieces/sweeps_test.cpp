#include "improve/pieces/sweeps.hpp"

#include "improve/operations/over_constrained_count.hpp"
#include "tests/improve/pieces.hpp"
#include "tests/improve/shaken.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

mesh::Piece piece_of(const mesh::examples::WholeMesh& whole) {
  return mesh::examples::cut_piece(whole, 0, {});
}

/// A bad piece with the sweeps that work on it.
struct Improved {
  explicit Improved(mesh::Piece of, double target_angle = 15) : measure(target_angle), piece(std::move(of)) {}
  Improved(const Improved&) = delete;
  Improved& operator=(const Improved&) = delete;

  std::int64_t changes() const {
    return sweeps.counts().replaced + sweeps.counts().smoothed + sweeps.counts().slid;
  }
  /// Tetrahedra below the target, worst first.
  std::vector<LocalIndex> bad() const {
    std::vector<LocalIndex> tets;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t)
      if (mesh.is_alive(t) && mesh.quality(t) < measure.target()) tets.push_back(t);
    std::sort(tets.begin(), tets.end(),
              [&](LocalIndex a, LocalIndex b) { return mesh.quality(a) < mesh.quality(b); });
    return tets;
  }
  int over_constrained() const {
    int count = 0;
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t)
      count += mesh.is_alive(t) && count_boundary_faces(mesh, t) > 1 ? 1 : 0;
    return count;
  }

  mesh::TetQuality measure;
  mesh::Piece piece;
  LocalTarget local_target{measure};
  ChangeLimits limits;
  TetMesh mesh{piece, measure};
  Sweeps sweeps{mesh, local_target, limits};
};

TEST(Sweeps, LeavesAMeshAloneThatMeetsTheTarget) {
  Improved improved(piece_of(mesh::examples::whole_cube(3, 1)));
  ASSERT_TRUE(improved.bad().empty());
  const mesh::Piece before = piece_of(mesh::examples::whole_cube(3, 1));
  improved.sweeps.run(8);
  EXPECT_EQ(improved.changes(), 0);
  improved.mesh.finish();
  EXPECT_EQ(improved.piece.cells, before.cells);
  EXPECT_EQ(improved.piece.coordinates, before.coordinates);
}

TEST(Sweeps, NeverMakesTheWorstWorse) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    Improved improved(piece_of(examples::shaken_cube(4, 1, 25, seed)));
    const std::vector<LocalIndex> bad = improved.bad();
    ASSERT_GT(bad.size(), 10u);
    double worst = improved.mesh.quality(bad.front());
    const std::size_t count = bad.size();
    for (int run = 0; run < 3; ++run) {
      improved.sweeps.run(2);
      if (improved.bad().empty()) break;
      EXPECT_GE(improved.mesh.quality(improved.bad().front()), worst);
      worst = improved.mesh.quality(improved.bad().front());
    }
    EXPECT_LT(improved.bad().size(), count / 2);
    EXPECT_EQ(improved.sweeps.counts().slid, 0) << "without a model to slide on";
    improved.mesh.finish();
    EXPECT_NEAR(examples::volume(improved.piece), 1, 1e-12);
  }
}

TEST(Sweeps, AddsVerticesInLaterSweepsAlone) {
  std::int64_t added = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const mesh::Piece piece = piece_of(examples::shaken_cube(3, 1, 100, seed));
    Improved first(piece, 25), all(piece, 25);
    first.sweeps.run(2);
    EXPECT_EQ(first.mesh.vertex_count(), piece.vertex_count());
    EXPECT_GT(first.changes(), 0);
    all.sweeps.run(12);
    added += all.mesh.vertex_count() - piece.vertex_count();
  }
  EXPECT_GT(added, 0);
}

TEST(Sweeps, RestsWhereNothingHasChanged) {
  Improved improved(piece_of(examples::shaken_cube(4, 1, 25, 3)));
  ASSERT_GT(improved.bad().size(), 10u);
  improved.sweeps.follow_removal({});
  improved.sweeps.run(8);
  EXPECT_EQ(improved.changes(), 0);
}

TEST(Sweeps, BeginsWithWhatIsFresh) {
  Improved one(piece_of(examples::shaken_cube(4, 1, 25, 3)));
  const int over_constrained = one.over_constrained();
  const LocalIndex worst = one.bad().front();
  const double quality = one.mesh.quality(worst);
  one.sweeps.follow_removal({worst});
  one.sweeps.run(8);
  EXPECT_GT(one.changes(), 0);
  EXPECT_TRUE(!one.mesh.is_alive(worst) || one.mesh.quality(worst) > quality);
  EXPECT_LE(one.over_constrained(), over_constrained);
}

}  // namespace
}  // namespace aeroloom::improve
