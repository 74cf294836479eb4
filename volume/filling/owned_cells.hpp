/// Which of a zone's tetrahedra are its own, and which region they lie in.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/filling/tetgen_run.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

using LocalTriangle = std::array<mesh::LocalIndex, 3>;
using LocalCell = std::array<mesh::LocalIndex, 4>;
/// The vertices of the face opposite to a vertex.
inline LocalTriangle face_of(const LocalCell& cell, int face) {
  const int* corner = mesh::tetrahedron_faces[face];
  return {cell[corner[0]], cell[corner[1]], cell[corner[2]]};
}

/// Whose a vertex is, seen from a zone.
enum class Owner : std::int8_t { mine, lower, higher };

/// The points and triangles that a zone is filled with, halo included. Vertices of the surface come first,
/// then lattice points, both in global order, which is the order of TetGen's symbolic perturbation.
struct ZoneProblem {
  std::vector<geometry::Vec3> points;
  std::vector<Owner> owners;             ///< per point: own zone, one of lower or of higher number
  std::vector<LocalTriangle> triangles;  ///< those of all vertices that are `mine`, at least
  std::vector<mesh::RegionId> front,
      back;  ///< regions on either side of each triangle; front: it is seen from outside
  std::vector<mesh::RegionId> regions;  ///< of the lattice points
  /// Triangles between the shell, which is filled, and the core: those at points that are `mine`, and near
  /// them, counter-clockwise seen from the core. They are not asked for but looked up.
  std::vector<LocalTriangle> borders;
  std::vector<mesh::RegionId> border_regions;

  static constexpr auto fields() {
    return std::tuple(&ZoneProblem::points, &ZoneProblem::owners, &ZoneProblem::triangles,
                      &ZoneProblem::front, &ZoneProblem::back, &ZoneProblem::regions, &ZoneProblem::borders,
                      &ZoneProblem::border_regions);
  }
  std::size_t surface_points() const { return points.size() - regions.size(); }
};

/// A face of a cell over which another zone's cell must be, or one of the core.
struct Crossing {
  std::int32_t cell;
  std::int32_t face;  ///< opposite to this vertex

  static constexpr auto fields() { return std::tuple(&Crossing::cell, &Crossing::face); }
};

/// The tetrahedra of a zone: those that have a vertex of it and none of a lower one.
struct OwnedCells {
  std::vector<LocalCell> cells;  ///< positive volume in VTK's order
  std::vector<mesh::RegionId> regions;
  std::vector<Crossing> crossings;
  std::vector<std::int32_t> triangles;  ///< whose front side they cover
  /// Points of the surface that cells of other zones may have too, be it in a corner alone; ascending.
  std::vector<mesh::LocalIndex> touched;
  std::vector<Crossing> borders;  ///< faces on the core's border
  /// Triangles of the border that are no faces of the mesh: then there are no cells.
  std::vector<std::int32_t> missing_borders;

  static constexpr auto fields() {
    return std::tuple(&OwnedCells::cells, &OwnedCells::regions, &OwnedCells::crossings,
                      &OwnedCells::triangles, &OwnedCells::touched, &OwnedCells::borders,
                      &OwnedCells::missing_borders);
  }
};

/// A tetrahedron with a lattice vertex off the core lies in the region of that. At another the star of a
/// vertex of the zone is searched, without crossing the surface, up to a triangle, one of the core's border
/// included, or such a lattice vertex: no tetrahedron elsewhere in the halo counts, since some reach through
/// triangles that the zone does not know. A point TetGen added belongs to the lowest zone in its star.
/// `points` has what TetGen added after the others. The mesh has all cells, or those with a vertex of the
/// zone where TetGen added no points. Throws std::runtime_error when a triangle at a vertex of the zone is
/// missing, or a cell is flat, inverted, or open.
OwnedCells select_owned(const ZoneProblem& problem, TetgenMesh mesh, std::span<const geometry::Vec3> points);

}  // namespace aeroloom::volume
