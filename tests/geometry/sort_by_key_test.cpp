#include "geometry/sort_by_key.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

using Item = std::pair<std::uint64_t, std::size_t>;

TEST(SortByKey, IsAStableSortForFewAndForMany) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0, 1, 100, 5000}) {
    // Few keys, which many share; keys that differ in their high digits alone; any keys.
    for (const auto& [mask, shift] : {std::pair{15ULL, 0}, std::pair{255ULL, 56}, std::pair{~0ULL, 0}}) {
      std::vector<Item> items;
      for (std::size_t i = 0; i < count; ++i) items.emplace_back((random() & mask) << shift, i);
      std::vector<Item> expected = items;
      std::sort(expected.begin(), expected.end());
      sort_by_key(items, [](const Item& item) { return item.first; });
      EXPECT_EQ(items, expected);
    }
  }
}

}  // namespace
}  // namespace aeroloom::geometry
