/// How large pieces of a volume are where nobody asks for a size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aeroloom::partition {

/// A sixty-fourth of so many tetrahedra: two pieces for each of 32 ranks. No fewer than 40,000: around
/// smaller pieces halos and borders cost half as much as the pieces; no more than 170,000: a billion, a third
/// of it filled by zones, has four zones for each of 512 ranks then.
inline std::int64_t suitable_piece_tets(double tetrahedra) {
  constexpr double usual_pieces = 64, least = 40'000, most = 170'000;
  return std::llround(std::clamp(tetrahedra / usual_pieces, least, most));
}

}  // namespace aeroloom::partition
