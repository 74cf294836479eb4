#include "geometry/disjoint_sets.hpp"
#include "geometry/runs.hpp"
#include "geometry/sort_by_number.hpp"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

TEST(DisjointSets, TheLowestNumberStandsForASetWhateverTheOrder) {
  const std::vector<std::pair<std::int32_t, std::int32_t>> pairs = {{7, 3}, {3, 5}, {8, 2}, {5, 2}};
  DisjointSets<std::int32_t> forward(10), backward(10);
  for (const auto& [a, b] : pairs) forward.unite(a, b);
  for (auto at = pairs.rbegin(); at != pairs.rend(); ++at) backward.unite(at->second, at->first);
  for (std::int32_t i = 0; i < 10; ++i) {
    const bool joined = i == 2 || i == 3 || i == 5 || i == 7 || i == 8;
    EXPECT_EQ(forward.root(i), joined ? 2 : i);
    EXPECT_EQ(backward.root(i), joined ? 2 : i);
  }
}

TEST(DisjointSets, AUnionWithinASetChangesNothing) {
  DisjointSets<std::int64_t> sets(3);
  sets.unite(0, 1);
  sets.unite(1, 0);
  EXPECT_EQ(sets.root(1), 0);
  EXPECT_EQ(sets.root(2), 2);
}

TEST(SortByNumber, IsASortByBoth) {
  struct Item {
    int number, rest;
    auto operator<=>(const Item&) const = default;
  };
  std::mt19937 random(5);
  for (const int numbers : {1, 7, 1000, 1000000}) {
    for (const std::size_t count : {0U, 1U, 500U}) {
      std::vector<Item> items(count);
      for (Item& item : items) item = {static_cast<int>(random() % numbers), static_cast<int>(random() % 20)};
      std::vector<Item> expected = items;
      std::sort(expected.begin(), expected.end());
      sort_by_number(
          items, [](const Item& item) { return item.number; },
          [](const Item& a, const Item& b) { return a.rest < b.rest; });
      EXPECT_EQ(items, expected) << numbers << ' ' << count;
    }
  }
}

using Runs = std::vector<std::pair<std::size_t, std::size_t>>;

Runs runs_of(const std::vector<int>& items) {
  Runs runs;
  for_each_run(std::span<const int>(items), std::equal_to<>{},
               [&](std::size_t first, std::size_t last) { runs.emplace_back(first, last); });
  return runs;
}

TEST(Runs, CoverTheListOnce) {
  EXPECT_EQ(runs_of({}), Runs{});
  EXPECT_EQ(runs_of({4}), (Runs{{0, 1}}));
  EXPECT_EQ(runs_of({4, 4, 5, 6, 6, 6}), (Runs{{0, 2}, {2, 3}, {3, 6}}));
  EXPECT_EQ(runs_of({1, 2, 1}), (Runs{{0, 1}, {1, 2}, {2, 3}})) << "only neighbours are compared";
}

}  // namespace
}  // namespace aeroloom::geometry
