/// Classification of bad tetrahedra, which miss the target angle. Pinned ones cannot reach it because the CAD
/// has a smaller angle there. Others are at features of the CAD finer than the elements, or held by a surface
/// or by layers that improvement must not change. The rest is what improvement failed to reach.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/quality/quality.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// A place of the CAD that forces small angles.
struct PinningEntity {
  /// Faces: two faces meet at a curve with a small angle. Curves: two curves meet with a small angle at a CAD
  /// vertex on a face.
  enum class Kind : std::int32_t { faces, curves };
  Kind kind = Kind::faces;
  std::array<std::int32_t, 2> faces{-1, -1};  ///< CAD faces, ascending; for curves twice the same
  std::int32_t vertex = -1;                   ///< CAD vertex, for curves
  double angle = 0;                           ///< degrees: smallest angle of the mesh there
  double smallest_dihedral = 0;               ///< degrees, of its tetrahedra
  geometry::Vec3 at;                          ///< position of that smallest angle
  std::int64_t tetrahedra = 0;
};

/// Walls closer to each other than their elements are long. Either a CAD face is narrow between two of its
/// curves (narrow_regions.hpp), or there is a gap between two faces (wall_pairs.hpp).
struct UnresolvedFeature {
  std::int32_t face = -1;
  std::int32_t opposite = -1;    ///< higher face of a gap; -1 for a narrow region
  double width = 0;              ///< smallest width at its tetrahedra
  double smallest_dihedral = 0;  ///< degrees, of its tetrahedra
  geometry::Vec3 at;             ///< middle of the narrowest edge or tetrahedron
  std::int64_t tetrahedra = 0;
};

/// Bad tetrahedra of one class. Without any: the target angle and the largest angle that goes with it.
struct MissedTarget {
  std::int64_t tetrahedra = 0;
  double smallest_angle = 0, largest_angle = 180;  ///< degrees
};

struct PinnedReport {
  std::vector<PinningEntity> entities;      ///< by kind, faces, vertex
  std::vector<UnresolvedFeature> features;  ///< by faces
  MissedTarget pinned;                      ///< forced by an angle of the CAD
  MissedTarget at_features;                 ///< not pinned, across a narrow region or gap
  MissedTarget held;    ///< neither, with three or more corners on a fixed surface or on layers
  MissedTarget beside;  ///< none of these, with a corner of one that is pinned or at a feature
  MissedTarget rest;
  std::int64_t tetrahedra = 0;  ///< pinned ones
  std::int64_t others = 0;      ///< bad ones that are not pinned
  /// Smallest and largest angle of the others, degrees.
  double smallest_angle = 0, largest_angle = 180;
};

/// Every tetrahedron that misses the target angle has an angle outside this range, degrees.
mesh::DihedralRange suspect_angles(double target_angle);

/// Classifies the tetrahedra that miss the target angle (degrees, as in ImproveOptions). A tetrahedron is
/// pinned at a mesh edge on a CAD curve if the boundary encloses less than the target there (a wedge).
/// Farther from the curve, it is pinned if the gap it spans and its smallest angle are at least half the
/// wedge's there. It is pinned on a boundary triangle that fills a corner of less than the target between two
/// curves. Of the others, those with an edge across a narrow region or reaching across a narrow gap are at
/// that feature. If the surface must stay, others with three or four corners on it are held. Others that
/// share a corner with a pinned one or one at a feature have to fit around it: they are beside it. `suspects`
/// are the tetrahedra outside suspect_angles(), as mesh::summarise_quality finds them. Collective; equal on
/// all ranks and for any number of ranks.
PinnedReport find_pinned(const mesh::NumberedMesh& mesh, double target_angle,
                         const mesh::CellsOutside& suspects, bool surface_may_change);

}  // namespace aeroloom::attribution
