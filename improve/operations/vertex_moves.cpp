#include "improve/operations/vertex_moves.hpp"

namespace aeroloom::improve {
namespace {

/// Calls move(v) for the vertices of a tetrahedron until it reaches its target; move(v) says whether it moved
/// the vertex, and leaves its tetrahedra in `star`. Returns how many have moved.
template <class Move>
std::int64_t move_vertices(OperationContext& context, LocalIndex t, RestingVertices& resting,
                           const std::vector<LocalIndex>& star, const Move& move) {
  std::int64_t moved = 0;
  const Corners corners = context.mesh().corners(t);
  for (const LocalIndex v : corners) {
    if (context.mesh().quality(t) >= context.target_of(t)) break;
    if (resting.contains(context.queue(), v)) continue;
    if (!move(v)) {
      resting.add(context, v);
      continue;
    }
    ++moved;
    context.note_moved(star, t);
  }
  return moved;
}

}  // namespace

bool VertexSmoothing::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  const std::int64_t moved = move_vertices(context, t, _resting, _star, [&](LocalIndex v) {
    return !mesh.is_fixed(v) && _smoothing.smooth(mesh, v, _star);
  });
  context.counts.smoothed += moved;
  return moved > 0;
}

bool VertexSliding::improve(OperationContext& context, LocalIndex t) {
  if (!_sliding) return false;
  const std::int64_t moved = move_vertices(
      context, t, _resting, _star, [&](LocalIndex v) { return _sliding->slide(context.mesh(), v, _star); });
  context.counts.slid += moved;
  return moved > 0;
}

}  // namespace aeroloom::improve
