/// Bits of lines on a surface, and the lines that they make.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"

#include <array>
#include <tuple>
#include <vector>

namespace aeroloom::picture {

/// A triangle or edge that lies on a line.
struct LineItem {
  std::array<mesh::GlobalIndex, 3> vertices;  ///< ascending; of an edge the last is there twice
  geometry::Vec3 point, normal, along;        ///< as in Place
  double length = 0, size = 0;

  static constexpr auto fields() {
    return std::tuple(&LineItem::vertices, &LineItem::point, &LineItem::normal, &LineItem::along,
                      &LineItem::length, &LineItem::size);
  }
};

/// By vertices; the two items of a sharp edge, one from each of its triangles, by what differs in them.
inline bool precedes(const LineItem& a, const LineItem& b) {
  return std::tie(a.vertices, a.size, a.along.x, a.along.y, a.along.z) <
         std::tie(b.vertices, b.size, b.along.x, b.along.y, b.along.z);
}

/// Line items that are connected by vertices.
struct SurfaceLine {
  std::vector<LineItem> items;  ///< by their vertices
  geometry::Box box;            ///< of the points of its items

  double extent() const { return box.diagonal(); }
};

/// All lines of the items of all ranks on rank 0, by their lowest vertices; nothing elsewhere. A function of
/// the set of all items. Collective.
std::vector<SurfaceLine> gather_lines(const parallel::Communicator& communicator,
                                      const std::vector<LineItem>& mine);

/// The mean of what is near an item: its direction, normal and size, over four sizes.
LineItem smoothed(const SurfaceLine& line, const LineItem& item);

}  // namespace aeroloom::picture
