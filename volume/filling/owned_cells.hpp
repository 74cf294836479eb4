/// Selects the tetrahedra that a zone owns, and finds their regions.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/filling/tetgen_run.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

using LocalTriangle = std::array<mesh::LocalIndex, 3>;
using LocalCell = std::array<mesh::LocalIndex, 4>;
/// The vertices of the face opposite to a vertex.
inline LocalTriangle face_of(const LocalCell& cell, int face) {
  const int* corner = mesh::tetrahedron_faces[face];
  return {cell[corner[0]], cell[corner[1]], cell[corner[2]]};
}

/// The owner of a vertex: the zone itself, or a zone with a lower or a higher number.
enum class Owner : std::int8_t { mine, lower, higher };

/// The points and triangles that a zone is filled with, halo included. Surface vertices come first, then
/// lattice points, both in global order. TetGen breaks ties by this order.
struct ZoneProblem {
  std::vector<geometry::Vec3> points;
  std::vector<Owner> owners;                    ///< per point
  std::vector<LocalTriangle> triangles;         ///< at least all with a vertex that is `mine`
  std::vector<mesh::RegionId> inside, outside;  ///< per triangle: its normal points from inside to outside
  std::vector<mesh::RegionId> regions;          ///< of the lattice points
  /// Border triangles between the core, filled by template, and the shell, filled by TetGen: at points that
  /// are `mine`, and near them. Counter-clockwise seen from the core. They are looked up in TetGen's mesh.
  std::vector<LocalTriangle> borders;
  std::vector<mesh::RegionId> border_regions;
  std::size_t surface_points() const { return points.size() - regions.size(); }
};

/// A face of a cell whose other side belongs to another zone or to the core.
struct Crossing {
  std::int32_t cell;
  std::int32_t face;  ///< the face opposite to this vertex of the cell
};

/// The tetrahedra that a zone owns: those with a vertex of the zone and no vertex of a lower zone.
struct OwnedCells {
  std::vector<LocalCell> cells;  ///< positive volume in VTK's order
  std::vector<mesh::RegionId> regions;
  std::vector<Crossing> crossings;
  std::vector<std::int32_t> triangles;  ///< with a cell on their inner side
  /// Surface points that cells of other zones may have too, if only as a corner; ascending.
  std::vector<mesh::LocalIndex> touched;
  std::vector<Crossing> borders;  ///< faces on the core's border
  /// Border triangles that are not in the mesh. If there are any, `cells` is empty.
  std::vector<std::int32_t> missing_borders;
};

/// Selects the owned cells. A cell with a lattice vertex that is `mine`, off the border, lies in its region.
/// For others, the star of a vertex of the zone is searched without crossing surface or border. The search
/// ends at such a lattice vertex or at a triangle. It stays in the star, because the zone may lack triangles
/// farther away. A point that TetGen added belongs to the lowest zone in its star; `points` has such points
/// last. The mesh must have all cells with a vertex of the zone; if TetGen added points, all cells. Throws
/// std::runtime_error if a triangle at a vertex of the zone is missing, or a cell is flat, inverted or open.
OwnedCells select_owned(const ZoneProblem& problem, TetgenMesh mesh, std::span<const geometry::Vec3> points);

}  // namespace aeroloom::volume
