#include "mesh/tokens.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

TEST(Tokens, OfSurfacesAscendByVertexCurveAndCut) {
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_LT(vertex_token(3), vertex_token(4));
  EXPECT_LT(vertex_token(most), curve_token(0, 0));
  EXPECT_LT(curve_token(0, most), curve_token(1, 0));
  EXPECT_LT(curve_token(5, 7), curve_token(5, 8));
  EXPECT_LT(curve_token(most - 1, most), cut_token(0, 0, 0));
  EXPECT_LT(cut_token(2, 3, 4), cut_token(2, 3, 5));
  EXPECT_LT(cut_token(2, 3, (1 << 24) - 1), cut_token(2, 4, 0));
  EXPECT_LT(cut_token(2, (1 << 16) - 1, 9), cut_token(3, 0, 0));
}

TEST(Tokens, TellWhatTheyWereMadeOf) {
  EXPECT_EQ(edge_of_token(vertex_token(12)), -1);
  EXPECT_EQ(index_of_token(vertex_token(12)), 12);
  EXPECT_EQ(edge_of_token(curve_token(7, 5)), 7);
  EXPECT_EQ(index_of_token(curve_token(7, 5)), 5);
  EXPECT_FALSE(is_cut_token(curve_token(7, 5)));
  EXPECT_TRUE(is_cut_token(cut_token(7, 5, 3)));
  EXPECT_EQ(edge_of_token(cut_token(7, 5, 3)), -1);
}

TEST(Tokens, CutsBeyondWhatCanBeNamedAreRefused) {
  EXPECT_NO_THROW(cut_token((1 << 23) - 1, (1 << 16) - 1, (1 << 24) - 1));
  EXPECT_THROW(cut_token(1 << 23, 0, 0), std::runtime_error);
  EXPECT_THROW(cut_token(0, 1 << 16, 0), std::runtime_error);
  EXPECT_THROW(cut_token(0, 0, 1 << 24), std::runtime_error);
}

TEST(Tokens, OfVolumesNeverMeet) {
  const std::int64_t many = std::int64_t{1} << 40;
  EXPECT_LT(running_token(many), added_token(0, 0));
  EXPECT_LT(added_token(3, 5), added_token(4, 0));
  EXPECT_LT(added_token((1 << 28), 5), late_token(0, 0, 0));
  EXPECT_LT(late_token(0, 3, 9), late_token(0, 4, 0));
  EXPECT_LT(late_token(0, (1 << 22), 9), late_token(1, 0, 0));
  EXPECT_LT(late_token(most_token_rounds, (1 << 22), 9), placed_token(0, 0));
  EXPECT_LT(placed_token(0, many), placed_token(1, 0));
}

}  // namespace
}  // namespace aeroloom::mesh
