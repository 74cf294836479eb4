/// Distinct numbers and their places among them.
#pragma once

#include "geometry/sort_unique.hpp"
#include "mesh/data/piece.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// Numbers lie densely as a rule: then a table answers instead of a search.
class IdTable {
public:
  IdTable() = default;
  /// From numbers in any order, each any number of times.
  explicit IdTable(std::vector<GlobalIndex> numbers) {
    if (numbers.empty()) return;
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    _low = *low;
    if (static_cast<std::size_t>(*high - *low) / 4 <= numbers.size()) {
      _places.assign(static_cast<std::size_t>(*high - *low) + 1, -1);
      for (const GlobalIndex number : numbers) _places[static_cast<std::size_t>(number - _low)] = 0;
      std::vector<GlobalIndex>().swap(numbers);
      for (std::size_t i = 0; i < _places.size(); ++i) {
        if (_places[i] < 0) continue;
        _places[i] = static_cast<LocalIndex>(_numbers.size());
        _numbers.push_back(_low + static_cast<GlobalIndex>(i));
      }
    } else {
      geometry::sort_unique(numbers);
      _numbers = std::move(numbers);
    }
    _numbers.shrink_to_fit();
  }

  /// Ascending.
  const std::vector<GlobalIndex>& numbers() const { return _numbers; }
  /// Of one of them.
  LocalIndex place(GlobalIndex number) const {
    if (!_places.empty()) return _places[static_cast<std::size_t>(number - _low)];
    return static_cast<LocalIndex>(std::lower_bound(_numbers.begin(), _numbers.end(), number) -
                                   _numbers.begin());
  }

private:
  std::vector<GlobalIndex> _numbers;
  std::vector<LocalIndex> _places;  // by number from _low on; -1: not there
  GlobalIndex _low = 0;
};

}  // namespace aeroloom::mesh
