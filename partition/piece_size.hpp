/// How large pieces are where nobody asks for a size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aeroloom::partition {

/// Pieces of a whole that is neither small nor large: two for each of eight ranks.
inline constexpr double usual_pieces = 16;

/// The size of pieces of a whole of so many elements, no smaller than `least` and no larger than `most`.
inline std::int64_t suitable_piece_size(double total, std::int64_t least, std::int64_t most) {
  const double size = std::clamp(total / usual_pieces, static_cast<double>(least), static_cast<double>(most));
  return std::llround(size);
}

}  // namespace aeroloom::partition
