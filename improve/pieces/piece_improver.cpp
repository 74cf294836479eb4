#include "improve/improver.hpp"
#include "improve/limits/examination.hpp"
#include "improve/operations/mean_ratio_smoothing.hpp"
#include "improve/operations/over_constrained_removal.hpp"
#include "improve/pieces/over_constrained_trials.hpp"
#include "improve/pieces/sweeps.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <numeric>

namespace aeroloom::improve {
namespace {

/// Sweeps after the removal of over-constrained tetrahedra, which changes the surroundings of bad ones.
constexpr int sweeps_after_removal = 3;

BadState state_of(const TetMesh& mesh) {
  Examination examination(mesh.measure());
  for (mesh::LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.is_alive(t)) examination.add(mesh.quality(t), mesh.points(t));
  }
  return examination.state;
}

/// The steps of docs/improvement.md within a piece.
class PieceImprover {
public:
  PieceImprover(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source, Effort effort)
      : _options(options),
        _sizes(source.sizes),
        _locator(options.boundary_may_change ? source.locator : nullptr),
        _effort(effort),
        _measure(options.target_angle),
        _narrow_target(piece, _measure),
        _local_target(effort == Effort::full ? LocalTarget(_measure) : _narrow_target),
        _mesh(piece, _measure, options.boundary_may_change),
        _limits(_sizes, &_narrow_target, effort) {
    report.note_before(state_of(_mesh));
  }

  void sweep(int most) {
    Sweeps sweeps(_mesh, _local_target, _limits, _effort, _locator);
    sweeps.run(most);
    report.smoothed += sweeps.counts().smoothed;
    report.slid += sweeps.counts().slid;
    report.replaced += sweeps.counts().replaced;
  }

  void remove_over_constrained() {
    if (const std::int64_t removed = OverConstrainedRemoval(_limits).run(_mesh); removed > 0) {
      report.replaced += removed;
      sweep(sweeps_after_removal);
      report.replaced += OverConstrainedRemoval(_limits).run(_mesh);
    }
    report.replaced += OverConstrainedTrials(_sizes, _options.over_constrained_trials, _effort).run(_mesh);
  }

  void smooth_average() { report.smoothed += MeanRatioSmoothing().run(_mesh, _options.relaxation); }

  /// Puts the cells back into the piece. Returns what each vertex was numbered before.
  const std::vector<mesh::LocalIndex>& finish() {
    report.note_after(state_of(_mesh));
    _mesh.finish();
    report.changed_triangles = _mesh.changed_triangles();
    return _mesh.origin();
  }

  ImproveReport report;

private:
  const ImproveOptions& _options;
  const sizing::SizeField* _sizes;
  cad::PointLocator* _locator;
  Effort _effort;
  mesh::TetQuality _measure;
  LocalTarget _narrow_target, _local_target;
  TetMesh _mesh;
  ChangeLimits _limits;
};

}  // namespace

ImproveReport improve_piece(mesh::Piece& piece, const ImproveOptions& options, const MeshSource& source,
                            std::vector<mesh::LocalIndex>* numbered, Effort effort) {
  if (!options.enabled) {
    ImproveReport report;
    report.note_before(examine(piece, mesh::TetQuality(options.target_angle)));
    if (numbered) {
      numbered->resize(piece.vertex_count());
      std::iota(numbered->begin(), numbered->end(), 0);
    }
    return report;
  }
  PieceImprover improver(piece, options, source, effort);
  improver.sweep(options.sweeps);      // 2. sweeps
  improver.remove_over_constrained();  // 3. over-constrained tetrahedra
  improver.smooth_average();           // 4. average
  const std::vector<mesh::LocalIndex>& origin = improver.finish();
  if (numbered) *numbered = origin;
  return improver.report;
}

}  // namespace aeroloom::improve
