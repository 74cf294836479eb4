#include "improve/relaxation.hpp"

#include "mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr double first_step = 0.15;  // of the mean distance to the neighbours
constexpr int most_halvings = 3;
constexpr double least_gain = 1e-3;  // of the mean of the inverse ratios

/// Its mean ratio (mesh::mean_ratio), from six times the volume and the sum of the squared edges.
double ratio(double volume6, double squares) {
  if (!(volume6 > 0)) return -1;
  const double root = std::cbrt(0.5 * volume6);
  return 12 * root * root / squares;
}

double squared(Vec3 v) {
  return dot(v, v);
}

}  // namespace

double Relaxation::minus_inverse_ratios(Vec3 p) const {
  double sum = 0;
  for (const Cone& k : _cones) {
    const double squares = k.squares + squared(p - k.a) + squared(p - k.b) + squared(p - k.c);
    const double each = ratio(dot(k.normal, p - k.a), squares);
    if (!(each > 0)) return -std::numeric_limits<double>::max();
    sum -= 1 / each;
  }
  return sum;
}

double Relaxation::minus_inverse_ratios(Vec3 p, Vec3& ascent) const {
  double sum = 0;
  ascent = {};
  for (const Cone& k : _cones) {
    const double squares = k.squares + squared(p - k.a) + squared(p - k.b) + squared(p - k.c);
    const double volume6 = dot(k.normal, p - k.a);
    const double each = ratio(volume6, squares);
    if (!(each > 0)) {
      sum = -std::numeric_limits<double>::max();
      continue;
    }
    sum -= 1 / each;
    const Vec3 outward = 3 * p - k.a - k.b - k.c;
    ascent += 1 / each * ((2 / (3 * volume6)) * k.normal - (2 / squares) * outward);
  }
  return sum;
}

bool Relaxation::move(TetMesh& mesh, LocalIndex v, Vec3 to, double least) {
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

void Relaxation::score_vertices(const TetMesh& mesh) {
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

bool Relaxation::relax(TetMesh& mesh, LocalIndex v) {
  mesh.collect_star(v, _star);
  _cones.clear();
  double worst = std::numeric_limits<double>::max(), reach = 0;
  const Vec3 origin = mesh.point(v);
  for (const LocalIndex t : _star) {
    const auto& face = mesh::tetrahedron_faces[mesh.local_vertex(t, v)];
    const Corners& c = mesh.corners(t);
    const Vec3 a = mesh.point(c[face[0]]), b = mesh.point(c[face[2]]), d = mesh.point(c[face[1]]);
    _cones.push_back({a, b, d, cross(b - a, d - a), squared(b - a) + squared(d - b) + squared(a - d)});
    worst = std::min(worst, mesh.quality(t));
    reach += distance(origin, a) / static_cast<double>(_star.size());
  }
  Vec3 direction;
  const double before = minus_inverse_ratios(origin, direction);
  const double slope = norm(direction);
  if (!(slope > 0)) return false;
  const double wanted = before + least_gain * static_cast<double>(_star.size());
  double length = first_step * reach;
  for (int halving = 0; halving <= most_halvings; ++halving, length *= 0.5) {
    const Vec3 candidate = origin + (length / slope) * direction;
    if (minus_inverse_ratios(candidate) >= wanted && move(mesh, v, candidate, worst)) return true;
  }
  return false;
}

std::int64_t Relaxation::run(TetMesh& mesh, int passes) {
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
