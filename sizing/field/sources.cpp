#include "sizing/field/sources.hpp"

#include "geometry/runs.hpp"
#include "geometry/sort_by_key.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace aeroloom::sizing {
namespace {

std::uint32_t cell_along(double offset, double cells_per_length) {
  const double t = offset * cells_per_length;
  if (!(t > 0)) return 0;
  return t < grid_size - 1 ? static_cast<std::uint32_t>(t) : grid_size - 1;
}

/// A source's cell: a one before the three bits per level of its path from the root.
std::uint64_t path_of(const RootCube& root, const SizeSource& source) {
  const int level = root.level(source.size);
  return 1ULL << 3 * level | morton_key(root.cell(source.point)) >> 3 * (finest_level - level);
}

auto rank_of(const SizeSource& source) {
  return std::tie(source.size, source.point.x, source.point.y, source.point.z);
}

}  // namespace

RootCube::RootCube(const geometry::Box& domain) {
  const geometry::Vec3 size = domain.size();
  edge = std::max({size.x, size.y, size.z});
  low = domain.center() - 0.5 * geometry::Vec3{edge, edge, edge};
  cells_per_length = grid_size / edge;
}

GridPoint RootCube::cell(geometry::Vec3 point) const {
  return {cell_along(point.x - low.x, cells_per_length), cell_along(point.y - low.y, cells_per_length),
          cell_along(point.z - low.z, cells_per_length)};
}

int RootCube::level(double edge_length) const {
  int exponent = 0;
  const double mantissa = std::frexp(edge / edge_length, &exponent);
  return std::clamp(mantissa > 0.5 ? exponent : exponent - 1, 0, finest_level);
}

std::vector<SizeSource> thin_sources(const RootCube& root, std::span<const SizeSource> sources) {
  std::vector<std::pair<std::uint64_t, std::size_t>> paths;
  paths.reserve(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) paths.emplace_back(path_of(root, sources[i]), i);
  geometry::sort_by_key(paths, [](const auto& path) { return path.first; });
  std::vector<SizeSource> kept;
  const auto same_cell = [](const auto& a, const auto& b) { return a.first == b.first; };
  geometry::for_each_run(std::span<const std::pair<std::uint64_t, std::size_t>>(paths), same_cell,
                         [&](std::size_t first, std::size_t last) {
                           std::size_t smallest = paths[first].second;
                           for (std::size_t i = first + 1; i < last; ++i) {
                             const std::size_t other = paths[i].second;
                             if (rank_of(sources[other]) < rank_of(sources[smallest])) smallest = other;
                           }
                           kept.push_back(sources[smallest]);
                         });
  return kept;
}

}  // namespace aeroloom::sizing
