/// Place along a space-filling curve (Morton, IBM technical report, 1966).
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>

namespace aeroloom::volume {

/// Spreads the low 21 bits of x to every third bit.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

/// Keys of points in a box, 21 bits per axis.
class SpaceFillingCurve {
public:
  explicit SpaceFillingCurve(const geometry::Box& box) : _low(box.low) {
    const geometry::Vec3 size = box.size();
    const double edge = std::max({size.x, size.y, size.z});
    _scale = edge > 0 ? 2097151.0 / edge : 0.0;
  }
  std::uint64_t key(geometry::Vec3 p) const {
    const geometry::Vec3 q = _scale * (p - _low);
    return spread_bits(static_cast<std::uint64_t>(q.x)) | spread_bits(static_cast<std::uint64_t>(q.y)) << 1 |
           spread_bits(static_cast<std::uint64_t>(q.z)) << 2;
  }

private:
  geometry::Vec3 _low;
  double _scale = 0;
};

}  // namespace aeroloom::volume
