/// How large pieces of a volume are where nobody asks for a size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aeroloom::partition {

/// A sixteenth of so many tetrahedra: two pieces for each of eight ranks. No fewer than 40,000: around
/// smaller pieces halos and borders cost as much as the pieces; no more than 500,000, for the memory of one
/// filling.
inline std::int64_t suitable_piece_tets(double tetrahedra) {
  constexpr double usual_pieces = 16, least = 40'000, most = 500'000;
  return std::llround(std::clamp(tetrahedra / usual_pieces, least, most));
}

}  // namespace aeroloom::partition
