#include "improve/operations/smoothing.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

// Numbers of the ascent were chosen, not measured one by one.

constexpr int most_steps = 12;          // of the ascent
constexpr int halvings_of_step = 6;     // of one step
constexpr double active_margin = 0.02;  // of quality: cones this close to the worst one shape the direction
constexpr double first_step = 0.1;      // of the mean distance to the neighbours
constexpr double longer = 4;            // the next step over one that gained: two halvings of it are no loss
constexpr double fraction_of_gain = 0.1;  // of what counts as a gain: a step with less ends the ascent
/// Of the mean distance: differences for slopes of quality, half of the digits of a double behind them.
constexpr double probe_step = 1e-6;
/// Steps towards the point next to the origin, and the gain over its square that ends them: the direction is
/// right to 2 degrees then.
constexpr int most_gradient_steps = 40;
constexpr double direction_gain = 1e-3;

/// The point of the convex hull of the vectors that lies next to the origin, by conditional gradients: the
/// direction in which the slowest of them grows fastest.
Vec3 nearest_to_origin(const std::vector<Vec3>& vectors) {
  Vec3 nearest = vectors[0];
  for (int i = 0; i < most_gradient_steps; ++i) {
    Vec3 extreme = vectors[0];
    for (const Vec3& v : vectors) {
      if (dot(v, nearest) < dot(extreme, nearest)) extreme = v;
    }
    const Vec3 step = extreme - nearest;
    const double gain = -dot(step, nearest);
    if (gain <= direction_gain * dot(nearest, nearest)) break;
    nearest += std::min(1.0, gain / dot(step, step)) * step;
  }
  return nearest;
}

}  // namespace

double ConeOptimiser::worst(const mesh::TetQuality& measure, Vec3 p, double floor) {
  double least = std::numeric_limits<double>::max();
  std::size_t decider = 0;
  for (std::size_t i = 0; i < _bases.size(); ++i) {
    const double quality = measure(_bases[i].a, _bases[i].b, _bases[i].c, p);
    if (quality >= least) continue;
    least = quality;
    decider = i;
    if (least <= floor) break;
  }
  std::swap(_bases[0], _bases[decider]);
  return least;
}

// A place without a gain need not be projected: projections cost more than measures of quality.
double ConeOptimiser::worst_on(const mesh::TetQuality& measure, Vec3& p, double floor, Locus& locus) {
  const Vec3 before = p;
  const double found = worst(measure, p, floor);
  if (found <= floor || !locus.project(p)) return floor;
  return p == before ? found : worst(measure, p, floor);
}

double ConeOptimiser::mean_distance(Vec3 p) const {
  double sum = 0;
  for (const Base& base : _bases) sum += distance(base.a, p);
  return sum / static_cast<double>(_bases.size());
}

Vec3 ConeOptimiser::ascent_direction(const mesh::TetQuality& measure, Vec3 p, double quality, double probe,
                                     const Locus& locus) {
  _gradients.clear();
  for (const Base& base : _bases) {
    const double here = measure(base.a, base.b, base.c, p);
    if (here > quality + active_margin) continue;
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 probed = p;
      probed[axis] += probe;
      gradient[axis] = (measure(base.a, base.b, base.c, probed) - here) / probe;
    }
    _gradients.push_back(locus.admissible(gradient));
  }
  return nearest_to_origin(_gradients);
}

double ConeOptimiser::climb(const mesh::TetQuality& measure, Vec3& p, double quality, Locus& locus) {
  const double size = mean_distance(p);
  double length = first_step * size;
  for (int i = 0; i < most_steps; ++i) {
    const Vec3 direction = normalized(ascent_direction(measure, p, quality, probe_step * size, locus));
    const double start = quality;
    Vec3 best = p;
    for (int halving = 0; halving <= halvings_of_step; ++halving, length *= 0.5) {
      Vec3 candidate = p + length * direction;
      const double found = worst_on(measure, candidate, quality, locus);
      if (found <= quality) {
        if (quality > start) break;
        continue;
      }
      quality = found;
      best = candidate;
    }
    if (quality <= start + fraction_of_gain * Smoothing::least_gain) break;
    p = best;
    length *= longer;
  }
  return quality;
}

double ConeOptimiser::optimise(const mesh::TetQuality& measure, Vec3& p, double quality, Locus& locus) {
  Vec3 mean;
  for (const Base& base : _bases) mean += base.a + base.b + base.c;
  mean = mean / (3 * static_cast<double>(_bases.size()));
  const double smoothed = worst_on(measure, mean, quality, locus);
  if (smoothed > quality) {
    p = mean;
    quality = smoothed;
  }
  return climb(measure, p, quality, locus);
}

bool Smoothing::smooth(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star) {
  mesh.collect_star(vertex, star);
  Space space;
  return smooth_on(mesh, vertex, star, space);
}

// Returns the worst quality.
double Smoothing::collect_cones(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star) {
  _cones.clear();
  double worst = std::numeric_limits<double>::max();
  for (const LocalIndex t : star) {
    const auto& face = mesh::tetrahedron_faces[mesh.local_vertex(t, vertex)];
    const Corners& c = mesh.corners(t);
    _cones.add(mesh.point(c[face[0]]), mesh.point(c[face[2]]), mesh.point(c[face[1]]));
    worst = std::min(worst, mesh.quality(t));
  }
  return worst;
}

bool Smoothing::promises(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star,
                         Locus& locus, double gain) {
  const double before = collect_cones(mesh, vertex, star);
  Vec3 moved = mesh.point(vertex);
  return _cones.optimise(mesh.measure(), moved, before, locus) >= before + gain;
}

bool Smoothing::smooth_on(TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star, Locus& locus,
                          double gain) {
  const double before = collect_cones(mesh, vertex, star);
  const Vec3 origin = mesh.point(vertex);
  Vec3 moved = origin;
  if (_cones.optimise(mesh.measure(), moved, before, locus) < before + gain) return false;
  mesh.move_vertex(vertex, moved, star);
  const bool holds = std::all_of(star.begin(), star.end(), [&](LocalIndex t) {
    return mesh.quality(t) > before && mesh.is_positive(mesh.corners(t));
  });
  if (holds && _limits.allow_move(mesh, vertex, star, origin)) return true;
  mesh.move_vertex(vertex, origin, star);
  return false;
}

}  // namespace aeroloom::improve
