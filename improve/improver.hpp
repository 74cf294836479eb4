/// The improvement stage: bad tetrahedra improved by local operations, never at the cost of a worse one.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "improve/mesh_source.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/piece.hpp"

#include <vector>

namespace aeroloom::parallel {
class TaskStore;
}

namespace aeroloom::improve {

/// Improves one tetrahedral piece in place: the worst element of any replacement gets better, then the
/// average (mean_ratio_smoothing.hpp), the worst element around a vertex not falling. Shared vertices
/// stay. Where the options allow it, edges on the boundary may flip and vertices inside a CAD face
/// vanish (boundary_change.hpp), and where the source is known vertices slide on CAD faces and curves
/// (sliding.hpp). Vertices inside may move, some are added (at the end) or removed (the others keep their
/// order); cells keep their order, new ones stand where those they replace stood. `numbered`, where asked
/// for, receives what each vertex was numbered before, new ones after the others. Deterministic. Not
/// collective. Throws std::invalid_argument when the target angle is not within (0, 50] degrees,
/// std::logic_error when three cells share a face.
ImproveReport improve_piece(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source = {},
                            std::vector<mesh::LocalIndex>* numbered = nullptr,
                            Effort effort = Effort::reduced);

/// Improves all pieces of a mesh, scheduled anew by the work expected, their borders frozen; then borders for
/// the average where they are (border_smoothing.hpp), and what is still bad in cavities in which borders are
/// inside (improve/borders/rounds.hpp), shifted from round to round; the last ones by several trials. All of
/// it once more for percentiles that are missed. The report counts the whole mesh, the same on every rank.
/// Pieces found in `tasks`, whose context stands for the source and the options, are not improved again on
/// their own; those improved are kept there. Collective. Throws CollectiveError.
ImproveReport improve_mesh(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                           const MeshSource& source = {}, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::improve
