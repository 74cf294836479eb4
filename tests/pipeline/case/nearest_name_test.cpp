#include "pipeline/case/nearest_name.hpp"

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

TEST(NearestNameTest, CountsEdits) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("sizng", "sizing"), 1);
  EXPECT_EQ(edit_distance("growht", "growth"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("ca", "abc"), 3);
}

TEST(NearestNameTest, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("directry", {"log", "directory"}), "directory");
  EXPECT_EQ(nearest_name("dir", {"log", "directory"}), "directory");
  EXPECT_EQ(nearest_name("quux", {"log", "directory"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
}

}  // namespace
}  // namespace aeroloom::cases
