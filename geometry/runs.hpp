/// Runs of equal items in a sorted list.
#pragma once

#include <cstddef>
#include <span>

namespace aeroloom::geometry {

/// Calls visit(first, last) for each maximal run of items with `same(first item of the run, item)`, in their
/// order. [first, last) are indices.
template <class Item, class Same, class Visit>
void for_each_run(std::span<const Item> items, const Same& same, const Visit& visit) {
  for (std::size_t first = 0; first < items.size();) {
    std::size_t last = first + 1;
    while (last < items.size() && same(items[first], items[last])) ++last;
    visit(first, last);
    first = last;
  }
}

}  // namespace aeroloom::geometry
