#include "mesh/data/cell_stars.hpp"

#include "mesh/data/pair_table.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <set>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

TEST(AscendingCellLocal, KnowsFacesAsTheirVerticesSay) {
  std::array<LocalIndex, 4> cell{3, 8, 11, 40};
  do {
    const AscendingCell ascending(cell.data());
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(cell[ascending.place(k)], ascending[k]);
      std::array<LocalIndex, 3> face{};
      for (int i = 0; i < 3; ++i) face[i] = cell[tetrahedron_faces[ascending.place(k)][i]];
      int inversions = 0;
      for (int i = 0; i < 3; ++i) inversions += face[i] > face[(i + 1) % 3];
      EXPECT_EQ(ascending.is_face_odd(k), inversions == 2);  // one: the vertices ascend but for a rotation
    }
  } while (std::next_permutation(cell.begin(), cell.end()));
}

TEST(CellStarsLocal, HaveEachFaceAtItsLowestVertex) {
  const Piece piece = examples::cube(Communicator::self(), 3, 1).pieces[0];
  const CellStars stars(piece, 2);
  std::multiset<std::array<LocalIndex, 3>> found, expected;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    stars.for_each(v, [&](LocalIndex, const AscendingCell& cell) {
      cell.for_each_face_of(v, [&](int, LocalIndex middle, LocalIndex highest) {
        found.insert({v, middle, highest});
      });
    });
  }
  for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
    for (const auto& f : tetrahedron_faces) {
      std::array<LocalIndex, 3> face{piece.cell(c)[f[0]], piece.cell(c)[f[1]], piece.cell(c)[f[2]]};
      std::sort(face.begin(), face.end());
      expected.insert(face);
    }
  }
  EXPECT_EQ(found, expected);
}

TEST(CellStarsLocal, GiveEachEdgeOnceAndAscending) {
  const Piece piece = examples::cube(Communicator::self(), 3, 1).pieces[0];
  std::vector<std::array<LocalIndex, 2>> found;
  for_each_edge(piece, [&](LocalIndex a, LocalIndex b) { found.push_back({a, b}); });
  std::set<std::array<LocalIndex, 2>> expected;
  for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
    for (const auto& [i, k] : tetrahedron_edges) {
      const LocalIndex a = piece.cell(c)[i], b = piece.cell(c)[k];
      expected.insert({std::min(a, b), std::max(a, b)});
    }
  }
  EXPECT_EQ(found, std::vector(expected.begin(), expected.end()));
}

TEST(PairTableLocal, TellsWhatMeetsAndWhatIsAlone) {
  PairTable table;
  for (const std::size_t keys : {10, 1000, 30}) {
    table.begin(2 * keys + 1);
    for (std::size_t k = 0; k < keys; ++k)
      EXPECT_EQ(table.add(k << 40, static_cast<std::uint32_t>(k)).count, 1U);
    EXPECT_FALSE(table.all_single([](std::uint32_t item) { return item != 7; }));
    for (std::size_t k = 0; k < keys; ++k) {
      const PairTable::Outcome met = table.add(k << 40, 0);
      EXPECT_EQ(met.count, 2U);
      EXPECT_EQ(met.first, k);
    }
    EXPECT_TRUE(table.all_single([](std::uint32_t) { return false; }));
    EXPECT_EQ(table.add(0, 5).count, 3U);
  }
}

}  // namespace
}  // namespace aeroloom::mesh
