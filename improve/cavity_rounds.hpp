/// Rounds that improve the tetrahedra still below target in cavities across the borders of pieces.
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

/// The rounds for one target. All but the constructor and note_state() are collective.
class CavityRounds {
public:
  /// All but `shared` must outlive it.
  CavityRounds(mesh::DistributedMesh& mesh, mesh::SharedVertices shared, const ImproveOptions& options,
               const MeshSource& source, StageRecord& record);

  /// Improves each cavity once, until nothing is left or as many rounds are done as the options allow.
  void improve_cavities();
  /// The last tetrahedra: larger cavities, the surface in them, the best of several trials each, so that no
  /// order of changes decides.
  void polish_last();
  /// Brings the record up to date with what is left.
  void note_state() { _record.mine.note_after(_bad.state(_mesh)); }

private:
  /// Claims cavities for the next round. Returns how many tetrahedra of the mesh they are for.
  std::int64_t claim(Effort effort);
  /// A round; without trials each cavity is improved once as it is.
  void run_round(cavities::CavityExtent extent, int trials);

  mesh::DistributedMesh& _mesh;
  mesh::SharedVertices _shared;
  const ImproveOptions& _options;
  mesh::TetQuality _measure;
  StageRecord& _record;
  BadCells _bad;
  cavities::CavityClaims _claims;
  CavityImprover _improver;
  int _shift = 0;  ///< rounds done: each shifts the grid that groups tetrahedra
  parallel::Progress _progress;
};

}  // namespace aeroloom::improve
