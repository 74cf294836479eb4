/// The improvement stage: bad tetrahedra mended by local operations, never at the cost of a worse one.
#pragma once

#include "geometry/point_locator.hpp"
#include "mesh/distributed_mesh.hpp"
#include "mesh/piece.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

struct ImproveOptions {
  bool enabled = true;
  double target_angle = 28;  ///< degrees; tetrahedra with a smaller dihedral angle, or a larger one than 180
                             ///< minus 1.5 times this, are worked on
  int sweeps = 12;           ///< at most; ends earlier when a sweep gains nothing
  int relaxation = 1;        ///< passes of smoothing for the average (relaxation.hpp)
  bool boundary_may_change = true;  ///< its triangles may flip and edges contract within one CAD face
  int shifted_rounds = 3;  ///< at most, across the borders of pieces; ends earlier when nothing is left
};

struct ImproveReport {
  std::int64_t bad_before = 0, bad_after = 0;        ///< tetrahedra that miss the target
  double min_angle_before = 0, min_angle_after = 0;  ///< degrees
  std::int64_t smoothed = 0;                         ///< vertices inside moved
  std::int64_t slid = 0;                             ///< vertices moved along CAD faces and curves
  std::int64_t swaps = 0;                            ///< cavities filled anew
  std::int64_t changed_triangles = 0;                ///< of the boundary
};

/// What the mesh was made from, as far as that is known.
struct MeshSource {
  geometry::PointLocator* locator = nullptr;  ///< of the CAD model: boundary vertices may slide on it
  const sizing::SizeField* sizes = nullptr;   ///< edges keep to them (change_limits.hpp)
};

/// Improves one tetrahedral piece in place: the worst element of any changed cavity gets better, then the
/// average (void_filling.hpp, relaxation.hpp), no worst element of a cavity falling. Interface and shared
/// vertices stay. Where the options allow it, edges on the boundary may flip and vertices inside a CAD face
/// vanish (boundary_change.hpp), and where the source is known vertices slide on CAD faces and curves
/// (sliding.hpp). Vertices inside may move, some are added (at the end) or removed (the others keep their
/// order); cells keep their order, new ones stand where those they replace stood. `numbered`, where asked
/// for, receives what each vertex was numbered before, new ones behind the others. Deterministic. Not
/// collective. Throws std::invalid_argument when the target angle is not within (0, 50] degrees,
/// std::logic_error when three cells share a face.
ImproveReport improve_piece(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source = {},
                            std::vector<mesh::LocalIndex>* numbered = nullptr);

/// Improves all pieces of a mesh, dealt out anew by the work expected, their borders frozen; then what is
/// poor on average or still bad beside borders, in cavities in which those borders are inside
/// (mesh/cavities.hpp), shifted from round to round. Collective.
ImproveReport improve_mesh(const parallel::Communicator& communicator, mesh::DistributedMesh& mesh,
                           const ImproveOptions& options, parallel::StageClock& clock,
                           const MeshSource& source = {});

}  // namespace aeroloom::improve
