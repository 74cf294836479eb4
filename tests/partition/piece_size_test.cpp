#include "partition/piece_size.hpp"

#include <gtest/gtest.h>

namespace aeroloom::partition {
namespace {

TEST(PieceSize, GivesEightRanksTwoPiecesEachAtAMillion) {
  EXPECT_EQ(suitable_piece_tets(1'000'000), 62'500);
  EXPECT_EQ(suitable_piece_tets(3'200'000), 200'000);
}

TEST(PieceSize, StaysWithinWhatPays) {
  EXPECT_EQ(suitable_piece_tets(1000), 40'000);
  EXPECT_EQ(suitable_piece_tets(1e8), 500'000);
}

}  // namespace
}  // namespace aeroloom::partition
