#include "sizing/choice/predict_counts.hpp"

#include "parallel/observation/timers.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/field/facet_integral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

constexpr double triangles_per_square = 4 / std::numbers::sqrt3;  // times 1/h^2
// Edges, over h, of a cube on the boundary that one value of h stands for; chosen, not measured.
constexpr double cube_per_size = 1;
constexpr int deepest_subdivision = 8;          // halvings; chosen, not measured
constexpr std::int64_t leaves_per_task = 1024;  // chosen, not measured

/// Whether the leaves share a piece of a face.
bool share_face(const SizeField::Leaf& a, const SizeField::Leaf& b) {
  int overlapping = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap =
        std::max(a.low[axis], b.low[axis]) - std::min(a.low[axis] + a.edge, b.low[axis] + b.edge);
    if (gap > 1e-6 * std::min(a.edge, b.edge)) return false;
    overlapping += gap < -0.5 * std::min(a.edge, b.edge);
  }
  return overlapping >= 2;
}

/// Integral of 1/h^3 over the part of leaves that lies inside the boundary.
class VolumeIntegral {
public:
  VolumeIntegral(const SizeField& field, const TriangleTree& boundary) : _field(field), _boundary(boundary) {}

  double over_leaves(std::int64_t first, std::int64_t last) {
    double sum = 0;
    std::array<Side, remembered_leaves> recent{};
    std::size_t clear_leaves = 0;
    std::vector<std::int32_t> touching;
    _depth = 0;
    for (std::int64_t i = first; i < last; ++i) {
      const SizeField::Leaf leaf = _field.leaf(i);
      find_touching(leaf.low, leaf.edge, near_leaf(i, leaf), touching);
      if (!touching.empty()) {
        sum += over_cut_cube(leaf.low, leaf.edge, touching, 0);
        continue;
      }
      // No boundary runs between leaves that are clear of it and share a face.
      const auto known = std::span(recent).first(std::min(clear_leaves, remembered_leaves));
      const auto next =
          std::find_if(known.begin(), known.end(), [&](const Side& s) { return share_face(s.leaf, leaf); });
      const bool inside =
          next != known.end() ? next->inside : _boundary.contains(leaf.low + 0.5 * leaf.edge * Vec3{1, 1, 1});
      recent[clear_leaves++ % remembered_leaves] = {leaf, inside};
      if (inside) sum += cube(leaf.edge / leaf.size);
    }
    return sum;
  }

private:
  struct Side {
    SizeField::Leaf leaf;
    bool inside;
  };
  static constexpr std::size_t remembered_leaves = 16;  // neighbours ask for the same; chosen, not measured
  static constexpr int levels_around = 3;  // above a leaf: the largest of the cubes; chosen, not measured
  static constexpr double margin = 1e-9;   // of the edge: a facet in a side of a cube touches it

  static double cube(double x) { return x * x * x; }

  static bool lies_in(const SizeField::Leaf& leaf, const SizeField::Leaf& cube) {
    const Vec3 away = leaf.low + 0.5 * leaf.edge * Vec3{1, 1, 1} - cube.low;
    return leaf.edge < cube.edge && std::min({away.x, away.y, away.z}) > 0 &&
           std::max({away.x, away.y, away.z}) < cube.edge;
  }

  /// Facets that touch the parent of a leaf, or a larger cube around it that none does. Those of its
  /// ancestors are kept for the leaves that come next.
  std::span<const std::int32_t> near_leaf(std::int64_t i, const SizeField::Leaf& leaf) {
    while (_depth > 0 && !lies_in(leaf, _around[_depth - 1].cube)) --_depth;
    if (_depth == 0) {
      const SizeField::Leaf cube = _field.ancestor(i, levels_around);
      _boundary.find_overlapping(with_margin(cube.low, cube.edge), margin_edge(cube.edge),
                                 room_for(cube).touching);
    }
    for (int up = levels_between(_around[_depth - 1].cube, leaf) - 1; up > 0; --up) {
      if (_around[_depth - 1].touching.empty()) break;
      const SizeField::Leaf cube = _field.ancestor(i, up);
      Surroundings& inner = room_for(cube);
      find_touching(cube.low, cube.edge, _around[_depth - 2].touching, inner.touching);
    }
    return _around[_depth - 1].touching;
  }

  static int levels_between(const SizeField::Leaf& above, const SizeField::Leaf& below) {
    constexpr double above_rounding = 1.5;  // edges are powers of two times the root's, rounded
    return std::ilogb(above_rounding * above.edge / below.edge);
  }

  struct Surroundings {
    SizeField::Leaf cube;
    std::vector<std::int32_t> touching;
  };
  /// The innermost of the cubes around a leaf, from now on.
  Surroundings& room_for(const SizeField::Leaf& cube) {
    if (_depth == _around.size()) _around.emplace_back();
    _around[_depth].cube = cube;
    return _around[_depth++];
  }

  /// The closed cube: a side of the domain may coincide with sides of leaves.
  static Vec3 with_margin(Vec3 low, double edge) { return low - margin * edge * Vec3{1, 1, 1}; }
  static double margin_edge(double edge) { return edge + 2 * margin * edge; }

  /// Facets in the closed cube, of those near it.
  void find_touching(Vec3 low, double edge, std::span<const std::int32_t> near,
                     std::vector<std::int32_t>& found) const {
    _boundary.keep_overlapping(with_margin(low, edge), margin_edge(edge), near, found);
  }

  /// A cube that the boundary passes, eighth by eighth until one value of h stands for it.
  double over_cut_cube(Vec3 low, double edge, const std::vector<std::int32_t>& touching, int depth) const {
    const double h = _field(low + 0.5 * edge * Vec3{1, 1, 1});
    if (edge <= cube_per_size * h || depth >= deepest_subdivision)
      return _boundary.fraction_behind(low, edge, touching) * cube(edge / h);
    const double half = 0.5 * edge;
    double sum = 0;
    std::vector<std::int32_t> inner;
    for (int child = 0; child < 8; ++child) {
      const Vec3 child_low = low + half * Vec3{double(child & 1), double(child >> 1 & 1), double(child >> 2)};
      find_touching(child_low, half, touching, inner);
      if (!inner.empty()) {
        sum += over_cut_cube(child_low, half, inner, depth + 1);
      } else if (_boundary.fraction_behind(child_low, half, touching) > 0.5) {
        sum += cube(half / _field(child_low + 0.5 * half * Vec3{1, 1, 1}));
      }
    }
    return sum;
  }

  const SizeField& _field;
  const TriangleTree& _boundary;
  std::vector<Surroundings> _around;  // cubes in each other, the first _depth
  std::size_t _depth = 0;
};

}  // namespace

double count_triangles(const SampledModel& sampled, const SizeField& field) {
  struct FaceCount {
    cad::FaceId face;
    double count;
  };
  std::vector<FaceCount> mine;
  {
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
    for (const SampledFace& face : sampled.own_faces()) {
      double sum = 0, area = 0;
      const auto& points = face.facets.points;
      for (const auto& t : face.facets.triangles) {
        const Triangle corners{points[t[0]], points[t[1]], points[t[2]]};
        area += area_of(corners);
        sum += integrate_facet(field, corners);
      }
      // Facets cut corners: the exact area makes up for it.
      if (area > 0) mine.push_back({face.id, triangles_per_square * sum * sampled.area(face.id) / area});
    }
  }
  double total = 0;
  for (const FaceCount& face : sampled.communicator().gather_sorted(mine, &FaceCount::face))
    total += face.count;
  return total;
}

double count_tetrahedra(const SampledModel& sampled, const SizeField& field) {
  const parallel::Communicator& communicator = sampled.communicator();
  const std::int64_t tasks = (field.leaf_count() + leaves_per_task - 1) / leaves_per_task;
  std::vector<double> mine;
  {
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
    VolumeIntegral integral(field, sampled.boundary());
    for (std::int64_t task = communicator.rank(); task < tasks; task += communicator.size()) {
      const std::int64_t first = task * leaves_per_task;
      mine.push_back(integral.over_leaves(first, std::min(first + leaves_per_task, field.leaf_count())));
    }
  }
  const std::vector<double> all = communicator.all_gather_items<double>(mine);
  // Summed in the order of tasks, whatever the number of ranks.
  std::vector<double> sums(tasks);
  std::size_t next = 0;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    for (std::int64_t task = rank; task < tasks; task += communicator.size()) sums[task] = all[next++];
  }
  double total = 0;
  for (const double sum : sums) total += sum;
  return tetrahedra_per_volume * total;
}

double count_everywhere(const SizeField& field) {
  constexpr double parts = 1000;  // of a tetrahedron: sums of whole numbers do not depend on their order
  const parallel::Communicator& communicator = field.communicator();
  std::int64_t sum = 0;
  {
    const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
    for (std::int64_t i = communicator.rank(); i < field.leaf_count(); i += communicator.size()) {
      const SizeField::Leaf leaf = field.leaf(i);
      sum += std::llround(parts * tetrahedra_per_volume * std::pow(leaf.edge / leaf.size, 3));
    }
  }
  return static_cast<double>(communicator.sum(sum)) / parts;
}

PredictedCounts predict_counts(const SampledModel& sampled, const SizeField& field) {
  return {count_triangles(sampled, field), count_tetrahedra(sampled, field)};
}

}  // namespace aeroloom::sizing
