#include "volume/lattice/range_maximum.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

TEST(RangeMaximum, is_what_looking_through_finds) {
  std::mt19937 random(7);
  for (const std::size_t size : {0, 1, 31, 32, 33, 64, 1000, 1024}) {
    std::vector<std::uint8_t> values(size);
    for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(random() % 200);
    const RangeMaximum ranges(values);
    for (std::size_t first = 0; first <= size; first += 1 + first / 7) {
      for (std::size_t last = first; last <= size; last += 1 + (last - first) / 5) {
        std::uint8_t expected = 0;
        for (std::size_t i = first; i < last; ++i) expected = std::max(expected, values[i]);
        ASSERT_EQ(ranges.over(first, last), expected) << first << " to " << last << " of " << size;
      }
    }
  }
}

}  // namespace
}  // namespace aeroloom::volume
