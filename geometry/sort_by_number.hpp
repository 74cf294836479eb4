/// Counting sort by small numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace aeroloom::geometry {

/// Sorts by `number(item)`, an index from 0 on, then by `less`. Takes linear time if few items share a number
/// and the largest number is not much above the number of items.
template <class Item, class Number, class Less>
void sort_by_number(std::vector<Item>& items, const Number& number, const Less& less) {
  constexpr std::size_t most_numbers_per_item = 8;
  std::size_t numbers = 0;
  for (const Item& item : items) numbers = std::max(numbers, static_cast<std::size_t>(number(item)) + 1);
  if (numbers > most_numbers_per_item * items.size()) {
    std::sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
      return number(a) != number(b) ? number(a) < number(b) : less(a, b);
    });
    return;
  }
  std::vector<std::size_t> first(numbers + 1, 0);
  for (const Item& item : items) ++first[number(item) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Item> sorted(items.size());
  std::vector<std::size_t> next(first.begin(), first.end());
  for (const Item& item : items) sorted[next[number(item)]++] = item;
  for (std::size_t n = 0; n < numbers; ++n) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first[n]),
              sorted.begin() + static_cast<std::ptrdiff_t>(first[n + 1]), less);
  }
  items.swap(sorted);
}

}  // namespace aeroloom::geometry
