/// Cells and faces on their way to parts. Internal to io/.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/distributed_table.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// Points under the ids of a file, or under numbers.
using PointStore = mesh::DistributedTable<std::array<double, 3>>;

/// Which rank has part p of `parts`.
inline parallel::Rank rank_of_part(std::int32_t part, std::int32_t parts, int ranks) {
  return static_cast<parallel::Rank>(static_cast<std::int64_t>(part) * ranks / parts);
}

/// A cell or face: its corners by number, where it belongs, and its place among those of its region or patch.
template <std::size_t N>
struct PartItem {
  std::array<mesh::GlobalIndex, N> corners;
  mesh::GlobalIndex order;
  std::int32_t part, id;

  static constexpr auto fields() {
    return std::tuple(&PartItem::corners, &PartItem::order, &PartItem::part, &PartItem::id);
  }
};

/// Of all shapes.
struct PartItems {
  std::tuple<std::vector<PartItem<4>>, std::vector<PartItem<5>>, std::vector<PartItem<6>>> cells;
  std::tuple<std::vector<PartItem<3>>, std::vector<PartItem<4>>> faces;
};

/// Calls `visit(std::integral_constant<std::size_t, s>)` for each shape.
template <class Visit>
void for_each_cell_shape(const Visit& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
  visit(std::integral_constant<std::size_t, 2>{});
}
template <class Visit>
void for_each_face_shape(const Visit& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
}

/// Who owns a vertex that several parts know.
enum class Ownership : std::uint8_t {
  by_number,  ///< numbers stay; part k owns the k-th share of them
  by_part,    ///< the lowest part that knows it, and numbers follow: by part, then in the order of old ones
};

/// Sends items to the ranks of their parts (rank_of_part) and makes a mesh of them: cells by region, faces by
/// patch, each in their order. `points` has all points by number. Collective.
FileMesh build_parts(const parallel::Communicator& communicator, PartItems items, const PointStore& points,
                     std::int32_t parts, Ownership ownership, std::vector<mesh::Patch> patches,
                     std::vector<std::string> regions);

}  // namespace aeroloom::io
