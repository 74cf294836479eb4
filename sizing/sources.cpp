#include "sizing/sources.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aeroloom::sizing {
namespace {

std::uint32_t cell_along(double offset, double cells_per_length) {
  const double t = offset * cells_per_length;
  if (!(t > 0)) return 0;
  return t < grid_size - 1 ? static_cast<std::uint32_t>(t) : grid_size - 1;
}

struct KeyedSource {
  int level;
  std::uint64_t key;
  SizeSource source;

  auto rank() const {
    return std::tie(level, key, source.size, source.point.x, source.point.y, source.point.z);
  }
};

}  // namespace

RootCube::RootCube(const geometry::Box& domain) {
  const geometry::Vec3 size = domain.size();
  edge = std::max({size.x, size.y, size.z});
  low = domain.center() - 0.5 * geometry::Vec3{edge, edge, edge};
}

GridPoint RootCube::cell(geometry::Vec3 point) const {
  const double cells_per_length = grid_size / edge;
  return {cell_along(point.x - low.x, cells_per_length), cell_along(point.y - low.y, cells_per_length),
          cell_along(point.z - low.z, cells_per_length)};
}

int RootCube::level(double edge_length) const {
  int exponent = 0;
  const double mantissa = std::frexp(edge / edge_length, &exponent);
  return std::clamp(mantissa > 0.5 ? exponent : exponent - 1, 0, finest_level);
}

std::vector<SizeSource> thin_sources(const RootCube& root, std::span<const SizeSource> sources) {
  std::vector<KeyedSource> keyed;
  keyed.reserve(sources.size());
  for (const SizeSource& source : sources) {
    const int level = root.level(source.size);
    keyed.push_back({level, morton_key(root.cell(source.point)) >> 3 * (finest_level - level), source});
  }
  std::sort(keyed.begin(), keyed.end(),
            [](const KeyedSource& a, const KeyedSource& b) { return a.rank() < b.rank(); });
  std::vector<SizeSource> kept;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].level != keyed[i - 1].level || keyed[i].key != keyed[i - 1].key) {
      kept.push_back(keyed[i].source);
    }
  }
  return kept;
}

}  // namespace aeroloom::sizing
