#include "improve/corner_relief.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr int passes = 2;

double worst_of(const TetMesh& mesh, const std::vector<LocalIndex>& tets) {
  double worst = std::numeric_limits<double>::max();
  for (const LocalIndex t : tets) worst = std::min(worst, mesh.quality(t));
  return worst;
}

}  // namespace

double CornerRelief::bar_of(const TetMesh& mesh, double before) const {
  return std::min(before, _share * mesh.measure().target());
}

int count_boundary_faces(const TetMesh& mesh, LocalIndex t) {
  int count = 0;
  for (int face = 0; face < 4; ++face) count += is_triangle(mesh.mate(4 * t + face)) ? 1 : 0;
  return count;
}

std::int64_t CornerRelief::run(TetMesh& mesh) {
  std::int64_t relieved = 0;
  for (int pass = 0; pass < passes; ++pass) {
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      if (mesh.is_alive(t) && count_boundary_faces(mesh, t) > 1 && relieve(mesh, t)) ++relieved;
    }
  }
  return relieved;
}

bool CornerRelief::relieve(TetMesh& mesh, LocalIndex t) {
  _best.clear();
  for (int face = 0; face < 4; ++face) swap_face(mesh, t, face);
  for (int edge = 0; edge < 6; ++edge) remove_edge(mesh, t, edge);
  if (!_best.new_tets.empty()) {
    mesh.replace(_best, _placed);
    return true;
  }
  for (int edge = 0; edge < 6; ++edge) {
    if (split_edge(mesh, t, edge)) return true;
  }
  return split_neighbourhood(mesh, t);
}

void CornerRelief::swap_face(const TetMesh& mesh, LocalIndex t, int face) {
  const HalfFace other = mesh.mate(4 * t + face);
  if (other < 0) return;
  const LocalIndex below = mesh.corners(t)[face], above = mesh.corners(other >> 2)[other & 3];
  _trial.clear();
  _trial.old_tets = {t, other >> 2};
  const auto& corner = mesh::tetrahedron_faces[face];
  for (int i = 0; i < 3; ++i)
    _trial.new_tets.push_back(
        {below, above, mesh.corners(t)[corner[i]], mesh.corners(t)[corner[(i + 1) % 3]]});
  consider(mesh);
}

void CornerRelief::remove_edge(const TetMesh& mesh, LocalIndex t, int edge) {
  if (!mesh.collect_edge_ring(t, edge, RingFilling::largest_ring, _edge_ring) || _edge_ring.ring.size() < 3)
    return;
  _trial.clear();
  _trial.old_tets = _edge_ring.tets;
  const double bar = bar_of(mesh, worst_of(mesh, _trial.old_tets));
  constexpr double just_below = 1 - 1e-12;
  if (_filling.solve(mesh, _edge_ring.start, _edge_ring.end, _edge_ring.ring, just_below * bar) < bar) return;
  _filling.emit(_trial.new_tets);
  consider(mesh);
}

void CornerRelief::consider(const TetMesh& mesh) {
  _trial.before = worst_of(mesh, _trial.old_tets);
  _trial.after = std::numeric_limits<double>::max();
  for (const Corners& c : _trial.new_tets) _trial.after = std::min(_trial.after, mesh.quality_of(c));
  if (_trial.after > _best.after && is_good(mesh, _trial)) std::swap(_best, _trial);
}

/// An interior edge gets a vertex where the worst tetrahedron around it is best.
bool CornerRelief::split_edge(TetMesh& mesh, LocalIndex t, int edge) {
  if (!mesh.collect_edge_ring(t, edge, RingFilling::largest_ring, _edge_ring) || _edge_ring.ring.size() < 3)
    return false;
  const auto& [start, end, tets, ring] = _edge_ring;
  Vec3 place = 0.5 * (mesh.point(start) + mesh.point(end));
  const LocalIndex middle = mesh.vertex_count();
  _trial.clear();
  _trial.old_tets = tets;
  _cones.clear();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const LocalIndex a = ring[i], b = ring[(i + 1) % ring.size()];
    for (const auto& [p, q, r] : {std::array{start, a, b}, std::array{end, b, a}}) {
      _trial.new_tets.push_back({p, q, r, middle});
      _cones.add(mesh.point(p), mesh.point(q), mesh.point(r));
    }
  }
  _trial.before = worst_of(mesh, tets);
  _trial.after = _cones.optimise(mesh.measure(), place, _cones.worst(mesh.measure(), place, -1));
  if (_trial.after < bar_of(mesh, _trial.before)) return false;
  mesh.add_vertex(place, start);
  if (!is_good(mesh, _trial)) {
    mesh.drop_last_vertex();
    return false;
  }
  mesh.replace(_trial, _placed);
  return true;
}

bool CornerRelief::fill_around_vertex(TetMesh& mesh, const std::vector<LocalIndex>& cavity) {
  const auto is_inside = [&](HalfFace side) {
    return side >= 0 && std::find(cavity.begin(), cavity.end(), side >> 2) != cavity.end();
  };
  const LocalIndex middle = mesh.vertex_count();
  Vec3 place{};
  _trial.clear();
  _trial.old_tets = cavity;
  _cones.clear();
  for (const LocalIndex t : cavity) {
    const Corners& c = mesh.corners(t);
    for (int face = 0; face < 4; ++face) {
      place += mesh.point(c[face]) / (4.0 * static_cast<double>(cavity.size()));
      if (is_inside(mesh.mate(4 * t + face))) continue;
      const auto& corner = mesh::tetrahedron_faces[face];
      const LocalIndex p = c[corner[0]], q = c[corner[2]], r = c[corner[1]];  // counter-clockwise from inside
      _trial.new_tets.push_back({p, q, r, middle});
      _cones.add(mesh.point(p), mesh.point(q), mesh.point(r));
    }
  }
  _trial.before = worst_of(mesh, cavity);
  _trial.after = _cones.optimise(mesh.measure(), place, _cones.worst(mesh.measure(), place, -1));
  if (_trial.after < bar_of(mesh, _trial.before)) return false;
  mesh.add_vertex(place, mesh.corners(cavity.front())[0]);
  if (!is_good(mesh, _trial)) {
    mesh.drop_last_vertex();
    return false;
  }
  mesh.replace(_trial, _placed);
  return true;
}

bool CornerRelief::split_neighbourhood(TetMesh& mesh, LocalIndex t) {
  std::array<LocalIndex, 4> beside;
  int count = 0;
  for (int face = 0; face < 4; ++face) {
    if (const HalfFace other = mesh.mate(4 * t + face); other >= 0) beside[count++] = other >> 2;
  }
  for (int last = count; last >= 0; --last) {  // all neighbours, then each alone
    _cavity = {t};
    if (last == count)
      _cavity.insert(_cavity.end(), beside.begin(), beside.begin() + count);
    else
      _cavity.push_back(beside[last]);
    if (fill_around_vertex(mesh, _cavity)) return true;
  }
  return false;
}

int CornerRelief::count_before(const TetMesh& mesh, const Replacement& cavity) {
  int count = 0;
  _sides.clear();
  for (const LocalIndex t : cavity.old_tets) {
    count += count_boundary_faces(mesh, t) > 1 ? 1 : 0;
    const Corners& c = mesh.corners(t);
    for (int face = 0; face < 4; ++face) {
      const auto& corner = mesh::tetrahedron_faces[face];
      if (is_triangle(mesh.mate(4 * t + face)))
        _sides.push_back(sorted(c[corner[0]], c[corner[1]], c[corner[2]]));
    }
  }
  return count;
}

int CornerRelief::count_after(const Replacement& cavity) const {
  const auto is_side = [&](const Corners& c, const auto& corner) {
    return std::find(_sides.begin(), _sides.end(), sorted(c[corner[0]], c[corner[1]], c[corner[2]])) !=
           _sides.end();
  };
  return static_cast<int>(
      std::count_if(cavity.new_tets.begin(), cavity.new_tets.end(), [&](const Corners& c) {
        return std::count_if(std::begin(mesh::tetrahedron_faces), std::end(mesh::tetrahedron_faces),
                             [&](const auto& corner) { return is_side(c, corner); }) > 1;
      }));
}

bool CornerRelief::is_good(const TetMesh& mesh, const Replacement& cavity) {
  if (cavity.after < bar_of(mesh, cavity.before)) return false;
  const int before = count_before(mesh, cavity);
  return count_after(cavity) < before &&
         std::all_of(cavity.new_tets.begin(), cavity.new_tets.end(),
                     [&](const Corners& c) { return mesh.is_positive(c); }) &&
         _limits.allow_sizes(mesh, cavity);
}

}  // namespace aeroloom::improve
