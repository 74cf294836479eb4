/// Makes cells from columns: prisms, pyramids and tetrahedra between wall and layer cap, as pieces of the
/// volume.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

struct LayerCellOptions {
  std::int64_t most_cells_per_piece = 0;  ///< exceeded only by the cells over a single triangle
  LayerElements elements = LayerElements::prisms;
  const OpenedWall* opened = nullptr;  ///< whose mesh the wall is, if it was opened
};

/// Appends the layer cells to the tetrahedra outside the layer cap. The boundary of these tetrahedra is still
/// the cap. `Piece::surface_numbers` holds the cap's vertex numbers and is removed. Pieces of the cap are
/// those of the wall in the same order; planes that were meshed again come last.
///
/// Layer k over a wall triangle lies between nodes min(k - 1, count) and min(k, count) of its columns, as
/// columns.hpp describes. If only tetrahedra are wanted, each cell is cut (Dompierre, Labbe, Vallet and
/// Camarero, How to subdivide pyramids, prisms, and hexahedra into tetrahedra, 8th International Meshing
/// Roundtable, 1999). The diagonal of a lateral face starts at the corner of the smallest number, first of
/// the cap vertex, then of the node. All tetrahedra cut from cells of build_layers() have positive volume.
///
/// A piece of layer cells is a range of triangles of one wall piece and lives on the rank of that piece. Its
/// id follows those of the tetrahedra, in the order of wall pieces. `Piece::layers` holds the layer of each
/// cell.
///
/// Wall triangles with a column at a corner become boundary of the layer cells. Other boundary triangles
/// stay. Planes that layers end on get lateral quadrilaterals and triangles. Nodes above the wall are
/// classified on their region, or on the plane that layers end on. Inner faces that were opened are one
/// again: both sides share the nodes in them, and the volume has the faces and patches of before. Collective.
void append_layers(const mesh::NumberedMesh& wall, const Columns& columns, const mesh::NumberedMesh& cap,
                   const LayerCellOptions& options, mesh::DistributedMesh& volume);

/// Whether triangles of the patch get layer cells: those of walls do.
inline bool bears_layers(const mesh::DistributedMesh& wall, std::int32_t patch) {
  return wall.type_of_patch(patch) == mesh::PatchType::wall;
}

}  // namespace aeroloom::layers
