#include "mesh/data/shared_vertex_keys.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

TEST(SharedVertexKeysLocal, OfSurfacesAscendByVertexCurveAndCut) {
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_LT(cad_vertex_key(3), cad_vertex_key(4));
  EXPECT_LT(cad_vertex_key(most), curve_vertex_key(0, 0));
  EXPECT_LT(curve_vertex_key(0, most), curve_vertex_key(1, 0));
  EXPECT_LT(curve_vertex_key(5, 7), curve_vertex_key(5, 8));
  EXPECT_LT(curve_vertex_key(most - 1, most), cut_vertex_key(0, 0, 0));
  EXPECT_LT(cut_vertex_key(2, 3, 4), cut_vertex_key(2, 3, 5));
  EXPECT_LT(cut_vertex_key(2, 3, (1 << 24) - 1), cut_vertex_key(2, 4, 0));
  EXPECT_LT(cut_vertex_key(2, (1 << 16) - 1, 9), cut_vertex_key(3, 0, 0));
  EXPECT_LT(cut_vertex_key((1 << 22) - 1, (1 << 16) - 1, (1 << 24) - 1), split_vertex_key(0, 0));
  EXPECT_LT(split_vertex_key(3, most), split_vertex_key(4, 0));
}

TEST(SharedVertexKeysLocal, TellWhatTheyWereMadeOf) {
  EXPECT_EQ(edge_of_vertex_key(cad_vertex_key(12)), -1);
  EXPECT_EQ(index_of_vertex_key(cad_vertex_key(12)), 12);
  EXPECT_EQ(edge_of_vertex_key(curve_vertex_key(7, 5)), 7);
  EXPECT_EQ(index_of_vertex_key(curve_vertex_key(7, 5)), 5);
  EXPECT_FALSE(is_cut_vertex_key(curve_vertex_key(7, 5)));
  EXPECT_TRUE(is_cut_vertex_key(cut_vertex_key(7, 5, 3)));
  EXPECT_EQ(edge_of_vertex_key(cut_vertex_key(7, 5, 3)), -1);
  EXPECT_TRUE(is_cut_vertex_key(split_vertex_key(7, 5)));
}

TEST(SharedVertexKeysLocal, NameColumnsOverAVertex) {
  for (const SharedVertexKey key :
       {cad_vertex_key(12), curve_vertex_key(7, 5), cut_vertex_key(7, 5, 3), split_vertex_key(7, 5)}) {
    ASSERT_TRUE(can_name_columns(key));
    EXPECT_NE(fan_vertex_key(key, 1), key);
    EXPECT_NE(fan_vertex_key(key, 255), fan_vertex_key(key, 254));
    EXPECT_EQ(is_cut_vertex_key(fan_vertex_key(key, 255)), is_cut_vertex_key(key));
    EXPECT_EQ(edge_of_vertex_key(fan_vertex_key(key, 255)), edge_of_vertex_key(key));
    EXPECT_THROW(fan_vertex_key(key, 256), std::runtime_error);
    EXPECT_THROW(fan_vertex_key(fan_vertex_key(key, 1), 1), std::runtime_error);
  }
  EXPECT_FALSE(can_name_columns(curve_vertex_key(7, 1 << 24)));
  EXPECT_FALSE(can_name_columns(cut_vertex_key(7, 5, 1 << 16)));
  EXPECT_FALSE(can_name_columns(split_vertex_key(7, 1 << 23)));
}

TEST(SharedVertexKeysLocal, NameSidesOfAVertex) {
  for (const SharedVertexKey key :
       {cad_vertex_key(12), curve_vertex_key(7, 5), cut_vertex_key(7, 5, 3), split_vertex_key(7, 5)}) {
    ASSERT_TRUE(can_name_sides(key));
    EXPECT_EQ(side_vertex_key(key, 0), key);
    EXPECT_EQ(vertex_key_of_side(side_vertex_key(key, last_vertex_side)), key);
    EXPECT_NE(side_vertex_key(key, 1), side_vertex_key(key, last_vertex_side));
    const SharedVertexKey side = side_vertex_key(key, last_vertex_side);
    EXPECT_EQ(is_cut_vertex_key(side), is_cut_vertex_key(key));
    EXPECT_EQ(edge_of_vertex_key(side), edge_of_vertex_key(key));
    EXPECT_TRUE(can_name_columns(side));
    EXPECT_NE(fan_vertex_key(side, 255), fan_vertex_key(key, 255));
    EXPECT_FALSE(can_name_sides(side));
    EXPECT_THROW(side_vertex_key(side, 1), std::runtime_error);
    EXPECT_THROW(side_vertex_key(key, last_vertex_side + 1), std::runtime_error);
  }
  EXPECT_FALSE(can_name_sides(curve_vertex_key(1 << 26, 0)));
  EXPECT_FALSE(can_name_sides(cut_vertex_key(1 << 17, 0, 0)));
  EXPECT_FALSE(can_name_sides(split_vertex_key(1 << 26, 0)));
  EXPECT_EQ(vertex_key_of_side(side_vertex_key(inside_vertex_key(7, 5), 3)), inside_vertex_key(7, 5));
  EXPECT_NE(inside_vertex_key(7, 5), split_vertex_key(7, 5));
  EXPECT_NE(side_vertex_key(inside_vertex_key(7, 5), 1), side_vertex_key(split_vertex_key(7, 5), 1));
}

TEST(SharedVertexKeysLocal, CutsBeyondWhatCanBeNamedAreRefused) {
  EXPECT_NO_THROW(cut_vertex_key((1 << 22) - 1, (1 << 16) - 1, (1 << 24) - 1));
  EXPECT_THROW(cut_vertex_key(1 << 22, 0, 0), std::runtime_error);
  EXPECT_THROW(cut_vertex_key(0, 1 << 16, 0), std::runtime_error);
  EXPECT_THROW(cut_vertex_key(0, 0, 1 << 24), std::runtime_error);
}

TEST(SharedVertexKeysLocal, OfVolumesNeverMeet) {
  const std::int64_t many = std::int64_t{1} << 40;
  EXPECT_LT(running_key(many), layer_key(0, 0));
  EXPECT_LT(layer_key(3, (1 << 20) - 1), layer_key(4, 0));
  EXPECT_LT(layer_key(many - 1, (1 << 20) - 1), added_key(0, 0));
  EXPECT_LT(added_key(3, 5), added_key(4, 0));
  EXPECT_LT(added_key((1 << 28), 5), late_key(0, 0, 0));
  EXPECT_LT(late_key(0, 3, 9), late_key(0, 4, 0));
  EXPECT_LT(late_key(0, (1 << 22), 9), late_key(1, 0, 0));
  EXPECT_LT(late_key(most_key_rounds, (1 << 22), 9), placed_key(0, 0));
  EXPECT_LT(placed_key(0, many), placed_key(1, 0));
}

}  // namespace
}  // namespace aeroloom::mesh
