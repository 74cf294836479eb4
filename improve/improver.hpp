/// The improvement stage: replaces bad tetrahedra by better ones with local operations. The worst tetrahedron
/// of a replaced cavity never gets worse.
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

/// Improves one tetrahedral piece in place. First the worst tetrahedra are improved. Then smoothing raises
/// the average quality without lowering the worst around a vertex. Shared vertices stay. If the options allow
/// it, boundary edges flip and vertices inside CAD faces vanish (boundary_change.hpp). If the CAD model is
/// known, boundary vertices slide on it (sliding.hpp). Interior vertices may move. New vertices come at the
/// end, and removed ones leave the order of the others. Cells keep their order; new ones take the places of
/// those they replace. `numbered`, if given, receives the former number of each vertex; new vertices have
/// higher numbers. Deterministic; not collective. Throws std::invalid_argument if the target angle is not in
/// (0, 50] degrees, std::logic_error if three cells share a face.
ImproveReport improve_piece(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source = {},
                            std::vector<mesh::LocalIndex>* numbered = nullptr,
                            Effort effort = Effort::reduced);

/// Improves all pieces of a mesh. Pieces are distributed by expected work and improved with frozen borders.
/// Then shared vertices are smoothed (border_smoothing.hpp). Remaining bad tetrahedra are improved in
/// cavities across borders, in several shifted rounds (borders/rounds.hpp). The last ones get several trials.
/// All steps are repeated for missed percentile targets. The report counts the whole mesh and is equal on all
/// ranks. If `tasks` is given, improved pieces are stored there and found again; its context must identify
/// source and options. Collective. Throws CollectiveError.
ImproveReport improve_mesh(mesh::DistributedMesh& mesh, const ImproveOptions& options,
                           const MeshSource& source = {}, parallel::TaskStore* tasks = nullptr);

}  // namespace aeroloom::improve
