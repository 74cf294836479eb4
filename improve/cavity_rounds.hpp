/// Improvement across the borders of pieces, in rounds of cavities around the remaining bad tetrahedra.
#pragma once

#include "improve/borders/bad_cells.hpp"
#include "improve/borders/cavity_improver.hpp"
#include "improve/borders/rounds.hpp"
#include "improve/improve_options.hpp"
#include "improve/mesh_source.hpp"
#include "improve/stage_record.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/quality/tet_quality.hpp"
#include "parallel/observation/progress.hpp"

#include <cstdint>

namespace aeroloom::improve {

/// The rounds for one target quality. All functions but the constructor and note_state() are collective.
class CavityRounds {
public:
  /// All arguments but `shared` must outlive the object.
  CavityRounds(mesh::DistributedMesh& mesh, mesh::SharedVertices shared, const ImproveOptions& options,
               const MeshSource& source, StageRecord& record);

  /// Improves each cavity once per round. Ends when no bad tetrahedra are left or the rounds of the options
  /// are done.
  void improve_cavities();
  /// Works on the last bad tetrahedra. Cavities are larger and include the surface. Several trials are made
  /// in each and the best is kept, so that the order of changes matters less.
  void polish_last();
  /// Updates the record with the present number of bad tetrahedra and the smallest angle.
  void note_state() { _record.mine.note_after(_bad.state(_mesh)); }

private:
  /// Claims cavities for the next round. Returns the number of bad tetrahedra they contain, over all ranks.
  std::int64_t claim(Effort effort);
  /// Does one round. With trials = 0 each cavity is improved once as it is.
  void run_round(cavities::CavityExtent extent, int trials);

  mesh::DistributedMesh& _mesh;
  mesh::SharedVertices _shared;
  const ImproveOptions& _options;
  mesh::TetQuality _measure;
  StageRecord& _record;
  BadCells _bad;
  cavities::CavityClaims _claims;
  CavityImprover _improver;
  int _shift = 0;  ///< rounds done; each shifts the grid that groups tetrahedra into cavities
  parallel::Progress _progress;
};

}  // namespace aeroloom::improve
