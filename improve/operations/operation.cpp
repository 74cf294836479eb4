#include "improve/operations/operation.hpp"

namespace aeroloom::improve {

bool OperationContext::allows(const CavityReplacement& change) {
  for (const Corners& c : change.new_tets) {
    if (_mesh.quality_of(c) <= change.before || !_mesh.is_positive(c)) return false;
  }
  return _mesh.keeps_baffles(change) && _local_target.accepts(_mesh, change) &&
         _limits.allow(_mesh, change) &&
         (!_over_constrained || _over_constrained->added_by(_mesh, change) <= 0);
}

bool OperationContext::apply(const CavityReplacement& change) {
  if (!allows(change)) return false;
  _mesh.replace(change, _placed);
  _queue.note_new(_placed);
  ++counts.replaced;
  return true;
}

bool OperationContext::apply_moving(const CavityReplacement& change, LocalIndex v, Vec3 position) {
  const Vec3 origin = _mesh.point(v);
  _mesh.move_vertex(v, position, {});
  if (apply(change)) return true;
  _mesh.move_vertex(v, origin, {});
  return false;
}

bool OperationContext::apply_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside) {
  _mesh.add_vertex(position, beside);
  if (apply(change)) return true;
  _mesh.drop_last_vertex();
  return false;
}

bool OperationContext::allows_adding(const CavityReplacement& change, Vec3 position, LocalIndex beside) {
  _mesh.add_vertex(position, beside);
  const bool allowed = allows(change);
  _mesh.drop_last_vertex();
  return allowed;
}

}  // namespace aeroloom::improve
