/// Tetrahedra that miss the target, classified: pinned ones, which cannot reach it because the CAD has an
/// angle smaller than it; those at features of the CAD that are finer than the elements; those held by a
/// surface or by layers that improvement was not to touch; and the rest, which improvement is to answer for.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/quality/quality.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::attribution {

/// A place of the CAD that forces small angles.
struct PinningEntity {
  /// Two faces that meet at a curve with a small angle between them, or two curves that meet so at a CAD
  /// vertex on a face.
  enum class Kind : std::int32_t { faces, curves };
  Kind kind = Kind::faces;
  std::array<std::int32_t, 2> faces{-1, -1};  ///< CAD faces, ascending; twice the same of two curves
  std::int32_t vertex = -1;                   ///< CAD vertex of two curves
  double angle = 0;                           ///< degrees: the smallest that the mesh has there
  double smallest_dihedral = 0;               ///< degrees, of its tetrahedra
  geometry::Vec3 at;                          ///< where that smallest angle is
  std::int64_t tetrahedra = 0;

  static constexpr auto fields() {
    return std::tuple(&PinningEntity::kind, &PinningEntity::faces, &PinningEntity::vertex,
                      &PinningEntity::angle, &PinningEntity::smallest_dihedral, &PinningEntity::at,
                      &PinningEntity::tetrahedra);
  }
};

/// Walls nearer to each other than the elements on them are long: a CAD face with a strip between two of its
/// curves (strip_triangles.hpp), or two faces with a gap between them (wall_pairs.hpp).
struct UnresolvedFeature {
  std::int32_t face = -1;
  std::int32_t opposite = -1;    ///< the other face of a gap, the higher one; -1 of a strip
  double width = 0;              ///< where it is narrowest among the tetrahedra counted
  double smallest_dihedral = 0;  ///< degrees, of its tetrahedra
  geometry::Vec3 at;             ///< inside, where it is narrowest
  std::int64_t tetrahedra = 0;

  static constexpr auto fields() {
    return std::tuple(&UnresolvedFeature::face, &UnresolvedFeature::opposite, &UnresolvedFeature::width,
                      &UnresolvedFeature::smallest_dihedral, &UnresolvedFeature::at,
                      &UnresolvedFeature::tetrahedra);
  }
};

/// Tetrahedra of one kind that miss the target. Without any, no angle is beyond the target.
struct MissedTarget {
  std::int64_t tetrahedra = 0;
  double smallest_angle = 0, largest_angle = 180;  ///< degrees
};

struct PinnedReport {
  std::vector<PinningEntity> entities;      ///< by kind, faces, vertex
  std::vector<UnresolvedFeature> features;  ///< by faces
  MissedTarget pinned;                      ///< forced by an angle of the CAD
  MissedTarget at_features;                 ///< not pinned, across such a strip or gap
  MissedTarget held;  ///< neither, with a side or all corners on a surface that may not change, or on layers
  MissedTarget rest;
  std::int64_t tetrahedra = 0;  ///< those pinned
  std::int64_t others = 0;      ///< those that are not pinned
  /// No tetrahedron that is not pinned goes beyond these, degrees.
  double smallest_angle = 0, largest_angle = 180;
};

/// All tetrahedra that miss the target angle have an angle beyond these, degrees.
mesh::DihedralRange suspect_angles(double target_angle);

/// Which tetrahedra that miss the target angle (degrees, as in ImproveOptions) are pinned: those at an edge
/// of a CAD curve where the boundary encloses less than the target; those behind the first row there, between
/// the same two faces, as narrow as the wedge is at their distance and no flatter, both to a factor of two;
/// and those on a boundary triangle that fills a corner of less than the target between two curves. Of the
/// others, those with an edge across a strip that is finer than its elements, or that reach across a gap
/// between two faces which is, are at that feature. Where the surface was to stay as it is, others with three
/// or four corners on it are held by it. `suspects` are those beyond the angles above, as
/// mesh::summarise_quality finds them. Collective; the same on every rank and for any number of ranks.
PinnedReport find_pinned(const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                         double target_angle, const mesh::CellsOutside& suspects, bool surface_may_change);

}  // namespace aeroloom::attribution
