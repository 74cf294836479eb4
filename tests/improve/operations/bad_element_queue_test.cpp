#include "improve/operations/bad_element_queue.hpp"

#include "tests/improve/pieces.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

const mesh::TetQuality measure(28);
constexpr int low = 1, beside_strips = 3, high = 4;  // levels

/// Tetrahedra apart from each other over equal triangles, of these heights.
mesh::Piece make_tets(const std::vector<double>& heights) {
  std::vector<Vec3> points;
  std::vector<LocalIndex> cells;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = 4 * static_cast<double>(i);
    for (const Vec3 p : {Vec3{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, heights[i]}}) {
      cells.push_back(static_cast<LocalIndex>(points.size()));
      points.push_back(p);
    }
  }
  return examples::make_piece(points, cells);
}

std::vector<LocalIndex> pop_all(BadElementQueue& queue, int level) {
  std::vector<LocalIndex> tets;
  while (const std::optional<LocalIndex> t = queue.pop(level)) tets.push_back(*t);
  return tets;
}

/// A queue over a piece.
struct Queued {
  explicit Queued(mesh::Piece from)
      : piece(std::move(from)),
        local_target(piece, measure),
        mesh(piece, measure),
        queue(mesh, local_target, beside_strips) {}

  mesh::Piece piece;
  LocalTarget local_target;
  TetMesh mesh;
  BadElementQueue queue;
};

using Tets = std::vector<LocalIndex>;

TEST(BadElementQueue, GivesTheWorstFirstAndTiesByTheirSlots) {
  Queued at(make_tets({0.3, 0.1, 1, 0.2, 0.1}));
  EXPECT_FALSE(at.queue.pop(low)) << "before a sweep begins";
  EXPECT_EQ(at.queue.fill(), 4) << "one reaches the target";
  // Equal heights give equal qualities, but for roundings of places.
  ASSERT_NEAR(at.mesh.quality(1), at.mesh.quality(4), 1e-12);
  const LocalIndex first = at.mesh.quality(4) < at.mesh.quality(1) ? 4 : 1;
  EXPECT_EQ(pop_all(at.queue, low), (Tets{first, 5 - first, 3, 0}));
  EXPECT_FALSE(at.queue.pop(low));

  mesh::Piece twins = make_tets({0.1, 0.1, 0.1});
  for (LocalIndex v = 4; v < twins.vertex_count(); ++v) twins.set_point(v, twins.point(v % 4));
  Queued equal(std::move(twins));
  equal.queue.fill();
  EXPECT_EQ(pop_all(equal.queue, low), (Tets{0, 1, 2}));
}

TEST(BadElementQueue, GivesAFailureAgainAtAHigherLevel) {
  Queued at(make_tets({0.1, 0.2}));
  at.queue.fill();
  at.queue.note_failure(0, low);
  EXPECT_EQ(pop_all(at.queue, low), Tets{1});
  at.queue.fill();
  EXPECT_EQ(pop_all(at.queue, beside_strips), (Tets{0, 1}));
  at.queue.note_failure(0, high);
  at.queue.fill();
  EXPECT_EQ(pop_all(at.queue, high), Tets{1});
}

TEST(BadElementQueue, GivesAFailureAgainWhenSomethingAroundItHasChanged) {
  Queued at(examples::make_octahedron({0.7, 0.1, 0.05}));  // all around one vertex
  const std::int64_t all = at.queue.fill();
  ASSERT_GE(all, 2);
  const Tets order = pop_all(at.queue, high);
  for (const LocalIndex t : order) at.queue.note_failure(t, high);
  at.queue.fill();
  EXPECT_TRUE(pop_all(at.queue, high).empty());
  const std::uint32_t before = at.queue.now();
  at.queue.note_moved({order.back()}, -1);
  EXPECT_GT(at.queue.now(), before);
  for (const LocalIndex v : at.mesh.corners(order.back())) EXPECT_TRUE(at.queue.has_changed_since(before, v));
  EXPECT_EQ(pop_all(at.queue, high), Tets{order.back()}) << "what has moved comes at once";
  at.queue.fill();
  EXPECT_EQ(pop_all(at.queue, high), order) << "its neighbours in the next sweep";
}

TEST(BadElementQueue, GivesWhatMovesOnceAndDefersWhatIsWorkedOn) {
  Queued at(make_tets({0.1, 0.2, 0.3}));
  at.queue.fill();
  at.queue.note_moved({0, 1}, -1);
  at.queue.note_moved({0, 2}, 0);
  EXPECT_EQ(pop_all(at.queue, low), (Tets{1, 2})) << "one entry each, none for the deferred one";
  at.queue.fill();
  EXPECT_EQ(pop_all(at.queue, low), (Tets{0, 1, 2}));
}

TEST(BadElementQueue, TakesTheNewQuality) {
  Queued at(make_tets({0.1, 0.2}));
  at.queue.fill();
  at.mesh.move_vertex(3, {0, 0, 0.25}, Tets{0});
  at.queue.note_moved({0}, -1);
  EXPECT_EQ(pop_all(at.queue, low), (Tets{1, 0}));
  at.mesh.move_vertex(3, {0, 0, 1}, Tets{0});
  at.queue.note_moved({0}, -1);
  EXPECT_FALSE(at.queue.pop(low)) << "it reaches the target now";
}

TEST(BadElementQueue, RestsAllButNewOnes) {
  Queued at(make_tets({0.1, 0.2, 0.3}));
  at.queue.rest_all_but({1}, high);
  at.queue.fill();
  EXPECT_EQ(pop_all(at.queue, high), Tets{1});
  at.queue.note_failure(1, high);
  at.queue.note_new({1});
  EXPECT_EQ(pop_all(at.queue, low), Tets{1}) << "a new tetrahedron has not failed";
}

/// A flat tetrahedron over a narrow triangle between two curves, and another apart.
mesh::Piece make_narrow(double height) {
  mesh::Piece piece = make_tets({height, 0.1});
  piece.set_point(2, {0.5, 0.04, 0});
  piece.set_point(3, {0.5, 0.02, height});
  std::fill_n(piece.vertex_dimension.begin(), 3, mesh::CadDimension::edge);
  piece.boundary = {0, 2, 1};
  piece.triangle_face = piece.triangle_patch = {0};
  return piece;
}

TEST(BadElementQueue, TriesNoFailureBesideStripsAgain) {
  for (const bool severe : {false, true}) {
    Queued at(make_narrow(severe ? 0.01 : 0.4));
    ASSERT_TRUE(at.local_target.is_limited(at.mesh.corners(0)));
    ASSERT_EQ(at.local_target.is_severe(at.mesh.quality(0)), severe);
    ASSERT_LT(at.mesh.quality(0), at.queue.target_of(0));
    EXPECT_EQ(at.queue.skips_costly(0), !severe);
    EXPECT_FALSE(at.queue.skips_costly(1)) << "not in the narrow region";
    const auto comes_again = [&](int failed_at) {
      at.queue.fill();
      pop_all(at.queue, high);
      at.queue.note_failure(0, failed_at);
      at.queue.note_failure(1, high);
      at.queue.note_moved({0}, 0);
      at.queue.fill();
      return pop_all(at.queue, high) == Tets{0};
    };
    EXPECT_TRUE(comes_again(low)) << "more operations follow";
    EXPECT_EQ(comes_again(beside_strips), severe);
    EXPECT_EQ(comes_again(high), severe);
  }
}

}  // namespace
}  // namespace aeroloom::improve
