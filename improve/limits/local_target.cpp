#include "improve/limits/local_target.hpp"

#include "mesh/data/cad_dimension.hpp"

#include <cmath>

namespace aeroloom::improve {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;

/// Of the target: a surface triangle is narrow if it lowers the target below this. Triangles up to five times
/// as long as wide are improved like others.
constexpr double narrow = 0.9;
/// Over the worst quality before: a severe case must reach this if it leaves a larger total deficit. Chosen,
/// not measured.
constexpr double far_better = 1.5;

/// The square of what a tetrahedron lacks of its local target, as a fraction of it.
double lack(double quality, double best) {
  const double lacking = std::max(0.0, 1 - quality / best);
  return lacking * lacking;
}

/// Height over the longest edge, divided by it.
double width_to_length(Vec3 a, Vec3 b, Vec3 c) {
  const double squared = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return norm(cross(b - a, c - a)) / squared;
}

}  // namespace

LocalTarget::LocalTarget(const mesh::Piece& piece, const mesh::TetQuality& measure)
    : _target(measure.target()) {
  for (LocalIndex i = 0; i < piece.boundary_count(); ++i) {
    const LocalIndex* v = piece.boundary_triangle(i);
    if (std::any_of(v, v + 3, [&](LocalIndex k) { return !is_on_curve(piece.vertex_dimension[k]); }))
      continue;
    const double least = std::sqrt(width_to_length(piece.point(v[0]), piece.point(v[1]), piece.point(v[2])));
    if (!(least < narrow * _target)) continue;
    if (_least.empty()) _least.assign(piece.vertex_count(), static_cast<float>(_target));
    for (int k = 0; k < 3; ++k) _least[v[k]] = std::min(_least[v[k]], static_cast<float>(least));
  }
}

double LocalTarget::between(double least, int count) const {
  const double step = std::cbrt(least / _target);
  return count == 1 ? step * _target : count == 2 ? step * step * _target : least;
}

bool LocalTarget::accepts(const TetMesh& mesh, const CavityReplacement& cavity) const {
  if (_least.empty()) return true;
  double before = 0, after = 0;
  bool limited = false;
  for (const LocalIndex t : cavity.old_tets) {
    const double best = (*this)(mesh.corners(t));
    limited = limited || best < _target;
    before += lack(mesh.quality(t), best);
  }
  for (const Corners& corners : cavity.new_tets) {
    const double best = (*this)(corners);
    limited = limited || best < _target;
    after += lack(mesh.quality_of(corners), best);
  }
  if (!limited || after < before) return true;
  return is_severe(cavity.before) && cavity.after >= std::min(far_better * cavity.before, severe * _target);
}

}  // namespace aeroloom::improve
