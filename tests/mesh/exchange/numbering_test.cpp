#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

/// Number, coordinates and owner of the vertices of all pieces, in piece order.
struct Row {
  PieceId piece;
  LocalIndex vertex;
  GlobalIndex number;
  std::int64_t owned;
  double x, y, z;

  static constexpr auto fields() {
    return std::tuple(&Row::piece, &Row::vertex, &Row::number, &Row::owned, &Row::x, &Row::y, &Row::z);
  }
  friend bool operator==(const Row&, const Row&) = default;
};

std::vector<Row> rows_of(const DistributedMesh& mesh) {
  const Communicator& communicator = mesh.communicator;
  const NumberedMesh numbered = number_mesh(mesh);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    for (LocalIndex v = 0; v < mesh.pieces[i].vertex_count(); ++v) {
      const auto p = mesh.pieces[i].point(v);
      rows.push_back({mesh.pieces[i].id, v, numbered.numbering.vertices[i][v], numbered.numbering.owned[i][v],
                      p.x, p.y, p.z});
    }
  }
  rows = communicator.all_gather_items(std::span<const Row>(rows));
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.piece, a.vertex) < std::pair(b.piece, b.vertex);
  });
  return rows;
}

class NumberingOfCube : public testing::TestWithParam<int> {};

TEST_P(NumberingOfCube, RunsByOwningPieceThenLocalOrder) {
  const auto rows = rows_of(examples::cube(Communicator::world(), 3, GetParam()));
  std::map<std::array<double, 3>, GlobalIndex> seen;
  GlobalIndex next = 0;
  for (const Row& row : rows) {
    const auto [found, is_new] = seen.emplace(std::array{row.x, row.y, row.z}, next);
    EXPECT_EQ(row.owned, is_new ? 1 : 0);
    EXPECT_EQ(row.number, found->second);
    next += is_new ? 1 : 0;
  }
  EXPECT_EQ(next, 64);
}

TEST_P(NumberingOfCube, IsTheSameOnOneRank) {
  NEEDS_SEVERAL_RANKS();
  const auto here = rows_of(examples::cube(Communicator::world(), 3, GetParam()));
  const auto alone = rows_of(examples::cube(Communicator::self(), 3, GetParam()));
  ASSERT_EQ(here.size(), alone.size());
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_TRUE(here[i] == alone[i]) << i;
}

INSTANTIATE_TEST_SUITE_P(Pieces, NumberingOfCube, testing::Values(1, 2, 4, 7, 27));

TEST(Numbering, CountsCubeAndFan) {
  const auto world = Communicator::world();
  const auto cube = examples::cube(world, 4, 5);
  const MeshCounts counts = count_mesh(number_mesh(cube));
  EXPECT_EQ(counts.vertices, 125);
  EXPECT_EQ(counts.cells, 6 * 64);
  EXPECT_EQ(counts.boundary_triangles, 6 * 2 * 16);
  const auto fan = examples::fan(world, 6);
  const NumberedMesh numbers = number_mesh(fan);
  EXPECT_EQ(numbers.numbering.vertex_count, 8);
  for (std::size_t i = 0; i < fan.pieces.size(); ++i)
    EXPECT_EQ(numbers.numbering.first_cell[i], fan.pieces[i].id);
}

TEST(Numbering, RefusesCoordinatesThatDifferInTheLastBit) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  for (Piece& piece : mesh.pieces) {
    if (piece.id != 1) continue;
    double& x = piece.coordinates[3 * piece.shared_vertices[2]];
    x = std::nextafter(x, 10.0);
  }
  try {
    number_mesh(mesh);
    FAIL() << "no rank may go on";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_NE(std::string(error.what()).find("disagree: 1."), std::string::npos) << error.what();
  }
}

TEST(Numbering, RefusesAKeyTwiceInOnePiece) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  for (Piece& piece : mesh.pieces) {
    if (piece.id != 0) continue;
    piece.set_point(piece.shared_vertices[1], piece.point(piece.shared_vertices[0]));
    piece.shared_keys[1] = piece.shared_keys[0];
  }
  EXPECT_THROW(number_mesh(mesh), parallel::CollectiveError);
}

TEST(Numbering, RefusesIndicesOutOfRange) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  for (Piece& piece : mesh.pieces) piece.cells[3] = piece.id == 1 ? 4 : piece.cells[3];
  EXPECT_THROW(number_mesh(mesh), parallel::CollectiveError);
}

TEST(Numbering, RefusesALostPiece) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  std::erase_if(mesh.pieces, [](const Piece& piece) { return piece.id == 1; });
  EXPECT_THROW(number_mesh(mesh), parallel::CollectiveError);
}

}  // namespace
}  // namespace aeroloom::mesh
