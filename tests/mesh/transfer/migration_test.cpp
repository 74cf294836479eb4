#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

TEST(PieceLocal, SurvivesPackingBitForBit) {
  const auto mesh = examples::cube(Communicator::self(), 2, 3);
  for (const Piece& piece : mesh.pieces) {
    const parallel::Bytes bytes = parallel::to_wire(piece);
    const Piece copy = parallel::from_wire<Piece>(bytes);
    EXPECT_EQ(copy.id, piece.id);
    EXPECT_EQ(copy.kind, piece.kind);
    EXPECT_EQ(parallel::to_wire(copy), bytes);
  }
}

TEST(PieceLocal, RefusesBytesThatAreTooFewOrTooMany) {
  const auto mesh = examples::two_tets(Communicator::self());
  parallel::Bytes bytes = parallel::to_wire(mesh.pieces[0]);
  bytes.push_back(std::byte{0});
  EXPECT_THROW(parallel::from_wire<Piece>(bytes), std::logic_error);
  bytes.resize(bytes.size() - 2);
  EXPECT_THROW(parallel::from_wire<Piece>(bytes), std::logic_error);
}

TEST(Delivery, ArrivesByAscendingSenderInTheSendersOrder) {
  struct Item {
    std::int32_t from, to, number;

    static constexpr auto fields() { return std::tuple(&Item::from, &Item::to, &Item::number); }
    bool operator==(const Item&) const = default;
  };
  const auto world = Communicator::world();
  const auto to = [](const Item& item) { return static_cast<parallel::Rank>(item.to); };
  const auto written_by = [&](int rank) {
    std::vector<Item> items;
    for (int i = 0; i < 40 + rank; ++i) items.push_back({rank, (i * i + rank) % world.size(), i});
    return items;
  };
  std::vector<Item> expected;
  for (int rank = 0; rank < world.size(); ++rank) {
    for (const Item& item : written_by(rank)) {
      if (item.to == world.rank()) expected.push_back(item);
    }
  }
  const std::vector<Item> mine = written_by(world.rank());
  EXPECT_EQ(deliver(world, mine, to), expected);
  EXPECT_EQ(mine, written_by(world.rank()));
  EXPECT_TRUE(deliver(world, std::vector<Item>{}, to).empty());
}

TEST(Migration, PutsEveryPieceWhereItsOwnerSays) {
  const auto world = Communicator::world();
  constexpr int pieces = 11;
  auto mesh = examples::cube(world, 3, pieces);
  const auto all = examples::cube(Communicator::self(), 3, pieces);
  std::vector<parallel::Rank> owner(pieces);
  for (int round = 0; round < 3; ++round) {
    for (int p = 0; p < pieces; ++p) owner[p] = (p * p + round) % world.size();
    migrate(mesh, owner);
    std::size_t next = 0;
    for (int p = 0; p < pieces; ++p) {
      if (owner[p] != world.rank()) continue;
      ASSERT_LT(next, mesh.pieces.size());
      EXPECT_EQ(parallel::to_wire(mesh.pieces[next++]), parallel::to_wire(all.pieces[p]));
    }
    EXPECT_EQ(next, mesh.pieces.size());
  }
}

TEST(Migration, CannotChangeTheHash) {
  const auto world = Communicator::world();
  auto mesh = examples::cube(world, 3, 5);
  const std::string before = hash_mesh(number_mesh(mesh));
  migrate(mesh, std::vector<parallel::Rank>(5, world.size() - 1));
  EXPECT_EQ(hash_mesh(number_mesh(mesh)), before);
}

TEST(Migration, RefusesOwnersThatDoNotFit) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  EXPECT_THROW(migrate(mesh, {0}), parallel::CollectiveError);
  EXPECT_THROW(migrate(mesh, {0, world.size()}), parallel::CollectiveError);
}

}  // namespace
}  // namespace aeroloom::mesh
