/// Sets as sorted vectors.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace aeroloom::geometry {

/// Sorts by `less` and keeps the first of each run of values that are `equal`.
template <class T, class Less = std::less<>, class Equal = std::equal_to<>>
void sort_unique(std::vector<T>& values, Less less = {}, Equal equal = {}) {
  std::sort(values.begin(), values.end(), less);
  values.erase(std::unique(values.begin(), values.end(), equal), values.end());
}

}  // namespace aeroloom::geometry
