#include "volume/lattice.hpp"

#include "mesh/mixing.hpp"
#include "volume/volume_mesher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::volume {

using geometry::Box;
using geometry::Vec3;

namespace {

/// Mean edge length of the Delaunay tetrahedra of a body-centred lattice, in edges of its cubic cell: of
/// fourteen neighbours six are 1 and eight are sqrt(3)/2 away.
constexpr double mean_edge_of_cell = (6.0 + 8.0 * 0.5 * std::numbers::sqrt3) / 14.0;
/// The size of boundary triangles counts in the clearance as far as it is within these bounds, in local
/// sizes.
constexpr double smallest_edge = 0.3, largest_edge = 1.5;
/// Balls without boundary the walk remembers.
constexpr std::size_t remembered_balls = 32;
/// Samples of the field that choose the scale of the lattice.
constexpr std::int64_t scale_samples = 4096;
/// Trilinear interpolation may be steeper than the growth limit by this factor.
constexpr double slope_margin = std::numbers::sqrt3;

/// The size the coarsest lattice is scaled to: maximum, or up to half an octave off, so that the levels suit
/// the sizes at which most of the mesh will have its elements (circular mean of log2 h, weighted by predicted
/// tetrahedra).
double reference_size(const sizing::SizeField& field) {
  const std::int64_t leaves = field.leaf_count();
  const std::int64_t stride = std::max<std::int64_t>(1, leaves / scale_samples);
  double cosine = 0, sine = 0;
  for (std::int64_t i = 0; i < leaves; i += stride) {
    const auto leaf = field.leaf(i);
    const double weight = std::pow(leaf.edge / leaf.size, 3);
    const double angle = 2 * std::numbers::pi * std::log2(leaf.size / field.maximum());
    cosine += weight * std::cos(angle);
    sine += weight * std::sin(angle);
  }
  return field.maximum() * std::exp2(std::atan2(sine, cosine) / (2 * std::numbers::pi));
}

/// Walks the octree over one piece.
class LatticeWalk {
public:
  LatticeWalk(const BoundaryDistance& boundary, const sizing::SizeField& field, const LatticeOptions& options)
      : _boundary(boundary),
        _field(field),
        _options(options),
        _anchor(field.domain().center()),
        _coarsest_edge(reference_size(field) / mean_edge_of_cell),
        _slope(slope_margin * std::log(field.options().growth)) {}

  Lattice run() {
    const Box& box = _boundary.box();
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      reach = std::max(
          {reach, std::abs(box.low[axis] - _anchor[axis]), std::abs(box.high[axis] - _anchor[axis])});
    }
    const int level = reach > _coarsest_edge ? -1 - std::ilogb(reach / _coarsest_edge) : 0;
    for (int octant = 0; octant < 8; ++octant) {
      visit({level, {(octant & 1) - 1, (octant >> 1 & 1) - 1, (octant >> 2) - 1}}, {});
    }
    return std::move(_lattice);
  }

private:
  /// A cell: edge is coarsest / 2^level, low corner at anchor + edge * index.
  struct CellIndex {
    int level;
    std::array<std::int64_t, 3> index;
  };
  /// What the parent cell knows.
  struct Surroundings {
    std::int32_t nearest = -1;  ///< a boundary triangle near the cell
    bool clear = false;         ///< the whole cell is inside and off the boundary
  };

  double edge_of(int level) const { return std::ldexp(_coarsest_edge, -level); }

  /// How many levels too coarse a level is for a size; within half a level it is the one wanted.
  bool is_wanted(int level, double size) const {
    const double ratio = edge_of(level) * mean_edge_of_cell / size;
    return ratio <= std::numbers::sqrt2 && ratio > 0.5 * std::numbers::sqrt2;
  }

  void visit(const CellIndex& cell, Surroundings around) {
    if (full()) return;
    const double edge = edge_of(cell.level), half_diagonal = 0.5 * std::numbers::sqrt3 * edge;
    const Vec3 low =
        _anchor + edge * Vec3{double(cell.index[0]), double(cell.index[1]), double(cell.index[2])};
    const Vec3 center = low + Vec3{0.5 * edge, 0.5 * edge, 0.5 * edge};
    if (!_boundary.box().overlaps({low, low + Vec3{edge, edge, edge}})) return;
    const double size = _field(center), variation = _slope * half_diagonal;
    const double smallest = std::max(size - variation, _field.minimum()), largest = size + variation;
    const bool has_children = edge * mean_edge_of_cell > std::numbers::sqrt2 * smallest;
    // A cell without children has two points at most, which is no more work than to explore it.
    if (has_children && !around.clear && !explore(center, half_diagonal, largest, around)) return;
    if (edge * mean_edge_of_cell <= std::numbers::sqrt2 * largest) {
      offer(low, cell, 0, _field(low), around);
      offer(center, cell, 1, size, around);
    }
    if (has_children) descend(cell, around);
  }

  void descend(const CellIndex& cell, const Surroundings& around) {
    for (int child = 0; child < 8; ++child) {
      visit({cell.level + 1,
             {2 * cell.index[0] + (child & 1), 2 * cell.index[1] + (child >> 1 & 1),
              2 * cell.index[2] + (child >> 2)}},
            around);
    }
  }

  /// Looks for the boundary around a cell. False when the cell is wholly outside.
  bool explore(Vec3 center, double half_diagonal, double largest_size, Surroundings& around) {
    const double range =
        half_diagonal + (largest_edge * _options.clearance + _options.perturbation) * largest_size;
    const auto nearest = _boundary.nearest(center, around.nearest, range);
    if (nearest.triangle >= 0) {
      around.nearest = nearest.triangle;
      return true;
    }
    around.clear = is_inside(center, nearest);
    return around.clear;
  }

  /// On which side a point is. No boundary lies in the balls around the points asked about last, so a point
  /// in such a ball is on its side; the walk goes from neighbour to neighbour, which makes this the rule.
  bool is_inside(Vec3 p, const BoundaryDistance::Nearest& nearest) {
    const auto ball = std::find_if(_empty_balls.begin(), _empty_balls.end(), [&](const EmptyBall& b) {
      return dot(p - b.center, p - b.center) < b.radius * b.radius;
    });
    const bool inside = ball != _empty_balls.end() ? ball->inside : _boundary.inside(p, nearest);
    _empty_balls[_next_ball++ % _empty_balls.size()] = {p, nearest.distance, inside};
    return inside;
  }

  void offer(Vec3 place, const CellIndex& cell, int center, double size, const Surroundings& around) {
    if (!is_wanted(cell.level, size)) return;
    const Vec3 p = place + perturbation(cell, center, size);
    if (around.clear) {
      _lattice.points.push_back(p);
    } else {
      offer_near_boundary(p, size, around.nearest);
    }
  }

  Vec3 perturbation(const CellIndex& cell, int center, double size) const {
    std::uint64_t state =
        mesh::mix_in(static_cast<std::uint64_t>(_options.variant), static_cast<std::uint64_t>(center));
    state = mesh::mix_in(state, static_cast<std::uint64_t>(cell.level));
    for (const std::int64_t i : cell.index) state = mesh::mix_in(state, static_cast<std::uint64_t>(i));
    Vec3 shift;
    for (int axis = 0; axis < 3; ++axis) {
      state = mesh::mix_in(state, 0);
      shift[axis] = _options.perturbation * size * (static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
    }
    return shift;
  }

  void offer_near_boundary(Vec3 p, double size, std::int32_t guess) {
    const auto limit = [&](std::int32_t triangle) {
      const bool continued = !_options.continued.empty() && _options.continued[triangle];
      return (continued ? _options.continued_clearance : _options.clearance) *
             std::clamp(_boundary.mean_edge(triangle), smallest_edge * size, largest_edge * size);
    };
    const double largest_limit = _options.clearance * largest_edge * size;
    const auto nearest = _boundary.nearest(p, guess, 1.2 * largest_limit);
    if (nearest.triangle >= 0 && nearest.distance < limit(nearest.triangle)) return;
    const bool inside = is_inside(p, nearest), near = nearest.distance < largest_limit;
    if (near && _boundary.any_nearer(p, largest_limit, limit)) return;
    if (inside) {
      _lattice.points.push_back(p);
    } else if (near && _boundary.box().contains(p)) {
      _lattice.scaffold.push_back(p);
    }
  }

  bool full() const { return static_cast<std::int64_t>(_lattice.points.size()) > _options.largest_count; }

  const BoundaryDistance& _boundary;
  const sizing::SizeField& _field;
  LatticeOptions _options;
  Vec3 _anchor;
  double _coarsest_edge;
  double _slope;
  /// A ball without boundary in it.
  struct EmptyBall {
    Vec3 center;
    double radius = 0;
    bool inside = false;
  };
  std::array<EmptyBall, remembered_balls> _empty_balls;
  std::size_t _next_ball = 0;
  Lattice _lattice;
};

}  // namespace

Lattice body_centred_lattice(const BoundaryDistance& boundary, const sizing::SizeField& field,
                             const LatticeOptions& options) {
  return LatticeWalk(boundary, field, options).run();
}

std::vector<Vec3> lattice_points(const ClosedSurface& surface, const sizing::SizeField& field,
                                 const VolumeOptions& options) {
  const BoundaryDistance boundary(surface.points, surface.triangles);
  return body_centred_lattice(boundary, field, {options.lattice_clearance, options.perturbation}).points;
}

}  // namespace aeroloom::volume
