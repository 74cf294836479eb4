/// From columns to cells: prisms, pyramids and tetrahedra between wall and cap, as pieces of the volume.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// A cap on its way through volume and improvement. Vertices are known there by their classification: the
/// dimension stays, so that nobody moves them, and the entity is their number.
struct NamedFront : mesh::NumberedMesh {
  std::vector<std::vector<std::int32_t>> entities;  ///< by piece and vertex: of the CAD
};

/// Throws CollectiveError where the cap has more vertices than entities can be counted by. Collective.
NamedFront name_cap(mesh::DistributedMesh cap);

struct LayerCellOptions {
  std::int64_t most_cells_per_piece = 0;  ///< where a triangle does not have more itself
  LayerElements elements = LayerElements::prisms;
};

/// Appends the cells of layers to the tetrahedra behind a named cap, whose boundary is still the cap's
/// triangles. Pieces of the cap are those of the wall, the same ones in the same order, but for planes that
/// were meshed again: theirs come last.
///
/// Over a triangle of the wall with the columns a, b, c layer k = 1 .. max(counts) lies between the nodes
/// min(k - 1, count) and min(k, count) of each: three that go on make a prism, two a pyramid, one a
/// tetrahedron. What lies over an edge depends on its two columns alone, so cells conform for any counts.
/// Elements that are tetrahedra cut each of these: the quadrilateral over an edge by the diagonal from its
/// corner of the smallest number, that of the cap's vertex and then of the node (Dompierre, Labbe, Vallet
/// and Camarero, How to subdivide pyramids, prisms, and hexahedra into tetrahedra, 8th International Meshing
/// Roundtable, 1999). So its columns rise to the next node one after another, that of the largest number
/// first, and each step is a tetrahedron. Any such cut of cells that build_layers() makes is positive.
/// Pieces are ranges of the
/// triangles of a piece of the wall, in the order of pieces, their ids follow those of the tetrahedra, and
/// they live where the wall's piece does. `Piece::layers` tells the layer of each cell.
///
/// Boundary faces of walls with a column at a corner go over to the layers as the wall has them; those of
/// other patches stay, and what layers end on there (a plane of symmetry) gets quadrilaterals and triangles
/// of its CAD face and patch. Vertices get their classification back; those off the wall lie in their region,
/// or on the plane that layers end on. Collective.
void append_layers(const mesh::NumberedMesh& wall, const Columns& columns, const NamedFront& cap,
                   const LayerCellOptions& options, mesh::DistributedMesh& volume);

/// Whether triangles of the patch get cells: those of walls.
inline bool bears_layers(const mesh::DistributedMesh& wall, std::int32_t patch) {
  return wall.type_of_patch(patch) == mesh::PatchType::wall;
}

}  // namespace aeroloom::layers
