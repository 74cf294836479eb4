/// Lists in messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::geometry {

/// The texts of the first `most` items, parted by commas, and how many more there are.
template <class Item, class Text>
std::string shown_list(const std::vector<Item>& items, const Text& text_of, std::size_t most = 3) {
  std::string shown;
  for (std::size_t i = 0; i < std::min(most, items.size()); ++i)
    shown += fmt::format("{}{}", i > 0 ? ", " : "", text_of(items[i]));
  if (items.size() > most) shown += fmt::format(" and {} more", items.size() - most);
  return shown;
}

}  // namespace aeroloom::geometry
