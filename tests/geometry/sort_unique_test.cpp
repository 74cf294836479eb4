#include "geometry/sort_unique.hpp"

#include <cstdint>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

TEST(SortUnique, keeps_each_value_once_in_order) {
  std::vector<std::int32_t> values{3, -1, 3, 7, -1, 0, 3};
  sort_unique(values);
  EXPECT_EQ(values, (std::vector<std::int32_t>{-1, 0, 3, 7}));
}

TEST(SortUnique, leaves_nothing_of_nothing) {
  std::vector<std::string> values;
  sort_unique(values);
  EXPECT_TRUE(values.empty());
}

TEST(SortUnique, sorts_by_a_comparison) {
  std::vector<std::int32_t> values{3, -1, 3, 7, -1};
  sort_unique(values, std::greater<>());
  EXPECT_EQ(values, (std::vector<std::int32_t>{7, 3, -1}));
}

TEST(SortUnique, keeps_the_first_of_equal_ones) {
  using Row = std::pair<std::int32_t, std::string>;
  std::vector<Row> rows{{2, "b"}, {1, "z"}, {2, "a"}, {1, "y"}};
  sort_unique(rows, std::less<>(), [](const Row& a, const Row& b) { return a.first == b.first; });
  EXPECT_EQ(rows, (std::vector<Row>{{1, "y"}, {2, "a"}}));
}

}  // namespace
}  // namespace aeroloom::geometry
