/// Connects edges and triangles to lines on a surface.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"

#include <array>
#include <tuple>
#include <vector>

namespace aeroloom::picture {

/// An edge or triangle on a line.
struct LineItem {
  std::array<mesh::GlobalIndex, 3> vertices;  ///< ascending; the last of an edge is repeated
  geometry::Vec3 point, normal, along;        ///< as in Place
  double length = 0, size = 0;
};

/// Orders by vertices, then by the values that differ between the two items of a sharp edge.
inline bool precedes(const LineItem& a, const LineItem& b) {
  return std::tie(a.vertices, a.size, a.along.x, a.along.y, a.along.z) <
         std::tie(b.vertices, b.size, b.along.x, b.along.y, b.along.z);
}

/// Items that are connected by vertices.
struct SurfaceLine {
  std::vector<LineItem> items;  ///< ordered by vertices
  geometry::Box box;            ///< of the items' points

  double extent() const { return box.diagonal(); }
};

/// The lines of all ranks' items on rank 0, ordered by lowest vertex; empty elsewhere. A function of the set
/// of all items. Collective.
std::vector<SurfaceLine> gather_lines(const parallel::Communicator& communicator,
                                      const std::vector<LineItem>& mine);

/// The item with normal, direction and size averaged over all items within four sizes.
LineItem smoothed(const SurfaceLine& line, const LineItem& item);

}  // namespace aeroloom::picture
