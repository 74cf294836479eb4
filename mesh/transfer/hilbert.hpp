/// Hilbert's curve through a cube of 2^21 cells along each side (Skilling, AIP Conference Proceedings 707,
/// 2004, doi:10.1063/1.1751381).
#pragma once

#include <array>
#include <cstdint>

namespace aeroloom::mesh {

inline constexpr int hilbert_bits = 21;

/// The place along the curve of a cell; coordinates below 2^21.
inline std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t highest = 1U << (hilbert_bits - 1);
  for (std::uint32_t q = highest; q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (std::uint32_t& c : x) {
      if (c & q) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ c) & below;
        x[0] ^= swapped;
        c ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flips = 0;
  for (std::uint32_t q = highest; q > 1; q >>= 1) {
    if (x[2] & q) flips ^= q - 1;
  }
  for (std::uint32_t& c : x) c ^= flips;
  std::uint64_t key = 0;
  for (int bit = hilbert_bits - 1; bit >= 0; --bit) {
    for (const std::uint32_t c : x) key = key << 1 | ((c >> bit) & 1U);
  }
  return key;
}

}  // namespace aeroloom::mesh
