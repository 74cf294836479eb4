/// Radix sort by 64-bit keys.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aeroloom::geometry {

/// Sorts by `key(item)`, a 64-bit number, in linear time. Items of equal keys keep their order.
template <class Item, class Key>
void sort_by_key(std::vector<Item>& items, const Key& key) {
  constexpr std::size_t few = 512;
  if (items.size() < few) {
    std::stable_sort(items.begin(), items.end(),
                     [&](const Item& a, const Item& b) { return key(a) < key(b); });
    return;
  }
  constexpr int digit_bits = 11, digits = 6;
  constexpr std::size_t values = std::size_t{1} << digit_bits;
  const auto digit = [](std::uint64_t number, int d) { return number >> d * digit_bits & (values - 1); };
  std::array<std::vector<std::size_t>, digits> places;
  for (std::vector<std::size_t>& each : places) each.assign(values, 0);
  for (const Item& item : items) {
    const std::uint64_t number = key(item);
    for (int d = 0; d < digits; ++d) ++places[d][digit(number, d)];
  }
  std::vector<Item> sorted(items.size());
  for (int d = 0; d < digits; ++d) {
    std::vector<std::size_t>& next = places[d];
    if (next[digit(key(items.front()), d)] == items.size()) continue;  // all have the same
    std::size_t sum = 0;
    for (std::size_t& each : next) {
      const std::size_t count = each;
      each = sum;
      sum += count;
    }
    for (const Item& item : items) sorted[next[digit(key(item), d)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace aeroloom::geometry
