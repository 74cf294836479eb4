#include "volume/filling/cell_order.hpp"

#include "geometry/morton.hpp"

#include <algorithm>

namespace aeroloom::volume {

using geometry::Vec3;

std::vector<std::uint32_t> order_along_curve(std::span<const Vec3> points,
                                             std::span<const std::array<mesh::LocalIndex, 4>> cells) {
  // By radix: a few bits of the key in each pass, the lowest ones first.
  constexpr int passes = 3, bits = 11;
  constexpr std::uint64_t mask = (1 << bits) - 1;
  geometry::Box box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 size = box.size();
  const double scale = static_cast<double>(mask) / std::max({size.x, size.y, size.z});
  struct CellKey {
    std::uint64_t key;
    std::uint32_t cell;
  };
  std::vector<CellKey> order(cells.size()), sorted(cells.size());
  std::array<std::array<std::uint32_t, mask + 2>, passes> first{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& c = cells[i];
    const Vec3 q = scale * (0.25 * (points[c[0]] + points[c[1]] + points[c[2]] + points[c[3]]) - box.low);
    const std::uint64_t key = geometry::morton_key(
        {static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y), static_cast<std::uint32_t>(q.z)});
    order[i] = {key, static_cast<std::uint32_t>(i)};
    for (int pass = 0; pass < passes; ++pass) ++first[pass][(key >> (pass * bits) & mask) + 1];
  }
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t k = 0; k < mask; ++k) first[pass][k + 1] += first[pass][k];
    for (const CellKey& place : order) sorted[first[pass][place.key >> (pass * bits) & mask]++] = place;
    order.swap(sorted);
  }
  std::vector<std::uint32_t> result(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) result[i] = order[i].cell;
  return result;
}

}  // namespace aeroloom::volume
