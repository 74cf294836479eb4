#include "improve/operations/vertex_insertion.hpp"

#include <utility>

namespace aeroloom::improve {

bool VertexReinsertion::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  const Corners corners = mesh.corners(t);
  for (const LocalIndex v : corners) {
    if (mesh.is_fixed(v) || _resting.contains(context.queue(), v)) continue;
    _resting.add(context, v);
    if (_insertion.propose_around_vertex(mesh, v, _trial) &&
        context.apply_moving(_trial, v, _insertion.position()))
      return true;
  }
  return false;
}

bool VertexInsertion::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  const int starts = context.effort() == Effort::full ? CavityInsertion::starts : 1;
  const LocalIndex beside = mesh.corners(t)[0];
  _best.clear();
  Vec3 position;
  for (int start = 0; start < starts; ++start) {
    if (!_insertion.propose_new_vertex(mesh, t, start, _trial) || _trial.after <= _best.after) continue;
    if (starts > 1 && !context.allows_adding(_trial, _insertion.position(), beside)) continue;
    std::swap(_best, _trial);
    position = _insertion.position();
  }
  return _best.improves() && context.apply_adding(_best, position, beside);
}

}  // namespace aeroloom::improve
