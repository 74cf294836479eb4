/// Morton keys: interleaved bits of grid coordinates. Sorting by key follows a space-filling curve.
#pragma once

#include <cstdint>

namespace aeroloom::geometry {

/// The finest level of an octree. A root cube of edge 1e6 has leaves of edge 1 on it. Corners of leaves, up
/// to 2^20, fit a 64-bit key.
inline constexpr int finest_level = 20;
inline constexpr std::uint32_t grid_size = 1U << finest_level;  ///< finest cells per axis

/// A corner of the finest grid, or the finest cell whose low corner it is.
struct GridPoint {
  std::uint32_t x = 0, y = 0, z = 0;

  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// Moves the 21 low bits of v three places apart.
inline std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/// The inverse of spread_bits().
inline std::uint32_t gather_bits(std::uint64_t v) {
  v &= 0x1249249249249249ULL;
  v = (v | v >> 2) & 0x10c30c30c30c30c3ULL;
  v = (v | v >> 4) & 0x100f00f00f00f00fULL;
  v = (v | v >> 8) & 0x1f0000ff0000ffULL;
  v = (v | v >> 16) & 0x1f00000000ffffULL;
  return static_cast<std::uint32_t>((v | v >> 32) & 0x1fffff);
}

/// Child c of a cell lies at offset (c & 1, c >> 1 & 1, c >> 2).
inline std::uint64_t morton_key(GridPoint p) {
  return spread_bits(p.x) | spread_bits(p.y) << 1 | spread_bits(p.z) << 2;
}

inline GridPoint grid_point(std::uint64_t key) {
  return {gather_bits(key), gather_bits(key >> 1), gather_bits(key >> 2)};
}

/// A cube of an octree: its low corner on the finest grid, and its level.
struct GridCube {
  GridPoint low;
  int level = 0;

  std::uint32_t edge() const { return grid_size >> level; }
  std::uint64_t key() const { return morton_key(low); }
  GridCube child(int c) const {
    const std::uint32_t half = edge() >> 1;
    return {{low.x + (c & 1 ? half : 0), low.y + (c & 2 ? half : 0), low.z + (c & 4 ? half : 0)}, level + 1};
  }

  friend bool operator==(const GridCube&, const GridCube&) = default;
};

}  // namespace aeroloom::geometry
