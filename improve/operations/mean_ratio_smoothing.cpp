#include "improve/operations/mean_ratio_smoothing.hpp"

#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr int most_halvings = 3;  // chosen, not measured

}  // namespace

bool MeanRatioSmoothing::move(TetMesh& mesh, LocalIndex v, Vec3 to, double least) {
  _after.clear();
  for (const LocalIndex t : _star) {
    std::array<Vec3, 4> p = mesh.points(t);
    p[mesh.local_vertex(t, v)] = to;
    _after.push_back(mesh.measure()(p[0], p[1], p[2], p[3]));
    if (_after.back() < least) return false;
  }
  const Vec3 origin = mesh.point(v);
  mesh.move_vertex(v, to, _star, _after);
  if (std::all_of(_star.begin(), _star.end(),
                  [&](LocalIndex t) { return mesh.is_positive(mesh.corners(t)); }))
    return true;
  mesh.move_vertex(v, origin, _star);
  return false;
}

void MeanRatioSmoothing::score_vertices(const TetMesh& mesh) {
  _mean.assign(mesh.vertex_count(), 0);
  std::vector<std::int32_t> count(mesh.vertex_count(), 0);
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (!mesh.is_alive(t)) continue;
    const Corners& c = mesh.corners(t);
    const auto value = static_cast<float>(
        mesh::mean_ratio(mesh.point(c[0]), mesh.point(c[1]), mesh.point(c[2]), mesh.point(c[3])));
    for (const LocalIndex v : c) {
      _mean[v] += value;
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < _mean.size(); ++v)
    _mean[v] = count[v] > 0 ? _mean[v] / static_cast<float>(count[v]) : 1;
}

bool MeanRatioSmoothing::relax(TetMesh& mesh, LocalIndex v) {
  mesh.collect_star(v, _star);
  _ratios.clear();
  double worst = std::numeric_limits<double>::max(), edge_sum = 0;
  const Vec3 origin = mesh.point(v);
  for (const LocalIndex t : _star) {
    const auto& face = mesh::tetrahedron_faces[mesh.local_vertex(t, v)];
    const Corners& c = mesh.corners(t);
    const Vec3 a = mesh.point(c[face[0]]);
    _ratios.add(a, mesh.point(c[face[2]]), mesh.point(c[face[1]]));
    worst = std::min(worst, mesh.quality(t));
    edge_sum += distance(origin, a);
  }
  const auto count = static_cast<double>(_star.size());
  Vec3 direction;
  const double before = _ratios.with_gradient(origin, direction);
  const double slope = norm(direction);
  if (!(slope > 0)) return false;
  const double wanted = before + least_gain * count;
  const auto at = [&](double length) { return origin + (length / slope) * direction; };
  const double step = first_step * edge_sum / count;
  const double after = before == InverseRatios::invalid ? before : _ratios(at(step));
  double length = step;
  if (after > InverseRatios::invalid) {
    const Peak peak = peak_along(slope, step, after - before);
    if (peak.rise < least_gain * count) return false;
    length = peak.step;
  }
  for (int halving = 0; halving <= most_halvings; ++halving, length *= 0.5) {
    const Vec3 candidate = at(length);
    if (_ratios(candidate) >= wanted && move(mesh, v, candidate, worst)) return true;
  }
  return false;
}

std::int64_t MeanRatioSmoothing::run(TetMesh& mesh, int passes) {
  score_vertices(mesh);
  std::int64_t moves = 0;
  for (int pass = 0; pass < passes; ++pass) {
    for (LocalIndex v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.is_fixed(v) || !mesh.is_used(v) || _mean[v] >= good_enough) continue;
      moves += relax(mesh, v);
    }
  }
  return moves;
}

}  // namespace aeroloom::improve
