/// Bits: places compared by them, which rank a key is met on, and the steps of the mesh hash.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <bit>
#include <cstdint>

namespace aeroloom::mesh {

/// A bijection of 64-bit words in which every input bit reaches every output bit (the finaliser of Steele,
/// Lea and Flood, OOPSLA 2014, doi:10.1145/2660193.2660195, with Stafford's 13th set of constants).
constexpr std::uint64_t mix_bits(std::uint64_t word) {
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

/// Mixes one more word into a running value.
constexpr std::uint64_t mix_in(std::uint64_t state, std::uint64_t word) {
  return mix_bits(state * 0x9e3779b97f4a7c15ULL + word);
}

/// Whether two places are the same in every bit: 0 and -0 differ, a NaN equals itself.
constexpr bool same_bits(const double (&a)[3], const double (&b)[3]) {
  const auto same = [&](int i) {
    return std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]);
  };
  return same(0) && same(1) && same(2);
}

/// The rank on which all holders of a key meet, from the key's mixed bits.
constexpr parallel::Rank meeting_rank(std::uint64_t mixed, int ranks) {
  return static_cast<parallel::Rank>(mixed % static_cast<std::uint64_t>(ranks));
}

}  // namespace aeroloom::mesh
