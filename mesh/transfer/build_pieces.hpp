/// Cells and boundary faces, spread over ranks anyhow, become the pieces of a mesh.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/distributed_table.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

namespace aeroloom::mesh {

/// A cell: its corners by number, where it belongs, its region, and its place among the cells of that.
template <std::size_t N>
struct CellItem {
  std::array<GlobalIndex, N> corners;
  GlobalIndex order;
  PieceId piece;
  RegionId group;
};

/// A boundary face: its corners by number, where it belongs, its patch and its CAD face.
template <std::size_t N>
struct FaceItem {
  std::array<GlobalIndex, N> corners;
  GlobalIndex order;
  PieceId piece;
  std::int32_t group, face;
};

/// Of all shapes.
struct PieceItems {
  std::tuple<std::vector<CellItem<4>>, std::vector<CellItem<5>>, std::vector<CellItem<6>>,
             std::vector<CellItem<8>>>
      cells;
  std::tuple<std::vector<FaceItem<3>>, std::vector<FaceItem<4>>> faces;
};

/// Calls `visit(std::integral_constant<std::size_t, s>)` for each shape.
template <class Visit>
void for_each_cell_shape(const Visit& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
  visit(std::integral_constant<std::size_t, 2>{});
  visit(std::integral_constant<std::size_t, 3>{});
}
template <class Visit>
void for_each_face_shape(const Visit& visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
}

/// Who owns a vertex that several pieces know.
enum class Ownership : std::uint8_t {
  by_number,  ///< numbers stay; piece k owns the k-th share of them, and knows those that it owns
  by_piece,   ///< the lowest piece that knows it, and numbers follow: by piece, then in the order of old ones
};

/// What lies under the numbers of vertices.
using PointTable = DistributedTable<std::array<double, 3>>;
struct VertexClass {
  std::int32_t dimension;  ///< a CadDimension; as wide as the entity, so that there is no padding
  std::int32_t entity;
};
using VertexClassTable = DistributedTable<VertexClass>;
struct VertexTables {
  const PointTable& points;
  const VertexClassTable* classes = nullptr;  ///< no pointer: the classification is unknown
};

/// Sends the items to the ranks of their pieces and puts these together: cells by region, faces by patch,
/// each in their order; vertices ascend by number, shared-vertex keys are the numbers that `items` came with.
/// `names` is the mesh without pieces. Collective; the same for any number of ranks.
NumberedMesh build_pieces(PieceItems items, const VertexTables& vertices, Ownership ownership,
                          DistributedMesh names);

}  // namespace aeroloom::mesh
