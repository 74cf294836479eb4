#include "mesh/transfer/piece_size.hpp"

#include <gtest/gtest.h>

namespace aeroloom::partition {
namespace {

TEST(PieceSize, GivesThirtyTwoRanksTwoPiecesEach) {
  EXPECT_EQ(suitable_piece_tets(6'400'000), 100'000);
  EXPECT_EQ(suitable_piece_tets(9'600'000), 150'000);
}

TEST(PieceSize, StaysWithinWhatPays) {
  EXPECT_EQ(suitable_piece_tets(1000), 40'000);
  EXPECT_EQ(suitable_piece_tets(1e8), 170'000);
}

}  // namespace
}  // namespace aeroloom::partition
