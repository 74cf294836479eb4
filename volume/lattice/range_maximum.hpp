/// The maximum of any range of an array of small numbers.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// A sparse table (Bender and Farach-Colton, LATIN 2000) over chunks of the array. It takes about half a byte
/// for each number. Partial chunks at the ends of a range are searched. Immutable.
class RangeMaximum {
public:
  RangeMaximum() = default;
  explicit RangeMaximum(std::vector<std::uint8_t> values) : _values(std::move(values)) {
    std::vector<std::uint8_t> row;
    for (std::size_t at = 0; at < _values.size(); at += chunk)
      row.push_back(largest(at, std::min(at + chunk, _values.size())));
    for (std::size_t width = 1; !row.empty(); width *= 2) {
      std::vector<std::uint8_t> wider;
      for (std::size_t c = 0; c + width < row.size(); ++c) wider.push_back(std::max(row[c], row[c + width]));
      _rows.push_back(std::move(row));
      row = std::move(wider);
    }
  }

  /// The maximum from `first` to before `last`; 0 for an empty range.
  std::uint8_t over(std::size_t first, std::size_t last) const {
    const std::size_t begin = (first + chunk - 1) / chunk, end = last / chunk;  // whole chunks
    if (begin >= end) return largest(first, last);
    const auto& row = _rows[static_cast<std::size_t>(std::bit_width(end - begin) - 1)];
    const std::size_t width = std::bit_floor(end - begin);
    return std::max(
        {row[begin], row[end - width], largest(first, begin * chunk), largest(end * chunk, last)});
  }

private:
  static constexpr std::size_t chunk = 32;
  std::uint8_t largest(std::size_t first, std::size_t last) const {
    std::uint8_t value = 0;
    for (std::size_t i = first; i < last; ++i) value = std::max(value, _values[i]);
    return value;
  }

  std::vector<std::uint8_t> _values;
  std::vector<std::vector<std::uint8_t>> _rows;  // row r, entry c: maximum of the 2^r chunks from c on
};

}  // namespace aeroloom::volume
