#include "improve/limits/change_limits.hpp"

#include "mesh/quality/quality.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

constexpr double least = 0.3,
                 most = 3;  // of the size, the former also of the mean edge before; docs/improvement.md

constexpr double decent_ratio = 0.5;  // below this a mean ratio must not fall; chosen, not measured
constexpr double flattening = 0.3;    // of the ratio before, where a severe case in a narrow region improves
constexpr double full_effort_flattening = 0.5;  // where any does, with full effort

double ratio_of(const std::array<Vec3, 4>& p) {
  return mesh::mean_ratio(p[0], p[1], p[2], p[3]);
}

/// Calls visit(a, b) for the edges of a tetrahedron; false as soon as it returns false.
template <class Visit>
bool for_edges(const TetMesh& mesh, const Corners& corners, const Visit& visit) {
  return std::all_of(
      std::begin(mesh::tetrahedron_edges), std::end(mesh::tetrahedron_edges),
      [&](const auto& e) { return visit(mesh.point(corners[e[0]]), mesh.point(corners[e[1]])); });
}

}  // namespace

void ChangeLimits::Lengths::add(Vec3 a, Vec3 b) {
  const double length = distance(a, b);
  shortest = std::min(shortest, length);
  longest = std::max(longest, length);
  sum += length;
  ++count;
}

bool ChangeLimits::allow_edge(const Lengths& before, Vec3 a, Vec3 b) const {
  const double length = distance(a, b);
  if (length >= before.shortest && length <= before.longest) return true;
  const double size = (*_field)(0.5 * (a + b));
  return length > before.longest ? length <= most * size
                                 : length >= least * std::min(size, before.sum / before.count);
}

bool ChangeLimits::allow_sizes(const TetMesh& mesh, const CavityReplacement& cavity) const {
  if (!_field) return true;
  Lengths before;
  for (const LocalIndex t : cavity.old_tets) {
    for_edges(mesh, mesh.corners(t), [&](Vec3 a, Vec3 b) {
      before.add(a, b);
      return true;
    });
  }
  return std::all_of(cavity.new_tets.begin(), cavity.new_tets.end(), [&](const Corners& corners) {
    return for_edges(mesh, corners, [&](Vec3 a, Vec3 b) { return allow_edge(before, a, b); });
  });
}

bool ChangeLimits::allow_moved_sizes(const TetMesh& mesh, LocalIndex vertex, std::span<const LocalIndex> star,
                                     Vec3 origin) const {
  if (!_field) return true;
  const Vec3 p = mesh.point(vertex);
  Lengths before;
  const auto for_neighbours = [&](const auto& visit) {
    return std::all_of(star.begin(), star.end(), [&](LocalIndex t) {
      const Corners& c = mesh.corners(t);
      return std::all_of(c.begin(), c.end(),
                         [&](LocalIndex v) { return v == vertex || visit(mesh.point(v)); });
    });
  };
  for_neighbours([&](Vec3 other) {
    before.add(origin, other);
    return true;
  });
  return for_neighbours([&](Vec3 other) { return allow_edge(before, p, other); });
}

bool ChangeLimits::touches_narrow_region(const TetMesh& mesh, std::span<const LocalIndex> tets) const {
  return _local_target && std::any_of(tets.begin(), tets.end(), [&](LocalIndex t) {
           return _local_target->is_limited(mesh.corners(t));
         });
}

bool ChangeLimits::allow(const TetMesh& mesh, const CavityReplacement& cavity) const {
  if (!allow_sizes(mesh, cavity)) return false;
  double poorest = decent_ratio;
  for (const LocalIndex t : cavity.old_tets) poorest = std::min(poorest, ratio_of(mesh.points(t)));
  if (_local_target && (_effort == Effort::full || _local_target->is_severe(cavity.before)) &&
      touches_narrow_region(mesh, cavity.old_tets)) {
    poorest *= _local_target->is_severe(cavity.before) ? flattening : full_effort_flattening;
  }
  return std::all_of(cavity.new_tets.begin(), cavity.new_tets.end(), [&](const Corners& c) {
    return ratio_of({mesh.point(c[0]), mesh.point(c[1]), mesh.point(c[2]), mesh.point(c[3])}) >= poorest;
  });
}

bool ChangeLimits::allow_move(const TetMesh& mesh, LocalIndex vertex, std::span<const LocalIndex> star,
                              Vec3 origin) const {
  if (!allow_moved_sizes(mesh, vertex, star, origin)) return false;
  double before = decent_ratio, after = decent_ratio;
  const bool narrow = touches_narrow_region(mesh, star);
  bool severe = false;
  for (const LocalIndex t : star) {
    std::array<Vec3, 4> p = mesh.points(t);
    after = std::min(after, ratio_of(p));
    p[mesh.local_vertex(t, vertex)] = origin;
    before = std::min(before, ratio_of(p));
    severe = severe || (narrow && _local_target->is_severe(mesh.measure()(p[0], p[1], p[2], p[3])));
  }
  return after >= (severe ? flattening * before : before);
}

}  // namespace aeroloom::improve
