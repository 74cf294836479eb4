#include "improve/operations/over_constrained_removal.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr int passes = 2;  // chosen, not measured

}  // namespace

double OverConstrainedRemoval::bar_of(const TetMesh& mesh, double before) const {
  return std::min(before, _fraction * mesh.measure().target());
}

std::int64_t OverConstrainedRemoval::run(TetMesh& mesh) {
  std::int64_t removed = 0;
  for (int pass = 0; pass < passes; ++pass) {
    for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
      if (mesh.is_alive(t) && count_boundary_faces(mesh, t) > 1 && remove(mesh, t)) ++removed;
    }
  }
  return removed;
}

bool OverConstrainedRemoval::remove(TetMesh& mesh, LocalIndex t) {
  _found.clear();
  find_swaps(mesh, t);
  if (_found.empty()) find_new_vertices(mesh, t);
  if (_found.empty()) return false;
  sort_found();
  apply(mesh, _found.front());
  return true;
}

const std::vector<OverConstrainedChange>& OverConstrainedRemoval::find(TetMesh& mesh, LocalIndex t) {
  _found.clear();
  find_swaps(mesh, t);
  find_new_vertices(mesh, t);
  sort_found();
  return _found;
}

const std::vector<LocalIndex>& OverConstrainedRemoval::apply(TetMesh& mesh,
                                                             const OverConstrainedChange& change) {
  if (change.place) mesh.add_vertex(*change.place, mesh.corners(change.cavity.old_tets.front())[0]);
  mesh.replace(change.cavity, _placed);
  return _placed;
}

void OverConstrainedRemoval::sort_found() {
  std::stable_sort(_found.begin(), _found.end(),
                   [](const OverConstrainedChange& a, const OverConstrainedChange& b) {
                     return a.cavity.after > b.cavity.after;
                   });
}

void OverConstrainedRemoval::find_swaps(const TetMesh& mesh, LocalIndex t) {
  for (int face = 0; face < 4; ++face) swap_face(mesh, t, face);
  for (int edge = 0; edge < 6; ++edge) remove_edge(mesh, t, edge);
}

void OverConstrainedRemoval::find_new_vertices(TetMesh& mesh, LocalIndex t) {
  for (int edge = 0; edge < 6; ++edge) split_edge(mesh, t, edge);
  split_neighbourhood(mesh, t);
  fill_stars(mesh, t);
}

void OverConstrainedRemoval::swap_face(const TetMesh& mesh, LocalIndex t, int face) {
  const HalfFace other = mesh.twin(4 * t + face);
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

void OverConstrainedRemoval::remove_edge(const TetMesh& mesh, LocalIndex t, int edge) {
  if (!mesh.collect_edge_ring(t, edge, RingFilling::largest_ring, _edge_ring) || _edge_ring.ring.size() < 3)
    return;
  _trial.clear();
  _trial.old_tets = _edge_ring.tets;
  const double bar = bar_of(mesh, mesh.worst_of(_trial.old_tets));
  constexpr double just_below = 1 - 1e-12;  // what is as good as the bar must be found
  if (_filling.solve(mesh, _edge_ring.start, _edge_ring.end, _edge_ring.ring, just_below * bar) < bar) return;
  _filling.emit(_trial.new_tets);
  consider(mesh);
}

void OverConstrainedRemoval::consider(const TetMesh& mesh) {
  _trial.before = mesh.worst_of(_trial.old_tets);
  _trial.after = std::numeric_limits<double>::max();
  for (const Corners& c : _trial.new_tets) _trial.after = std::min(_trial.after, mesh.quality_of(c));
  if (is_good(mesh, _trial)) _found.push_back({_trial, {}});
}

/// The trial's new tetrahedra are cones of a new vertex, which is optimised from this place.
void OverConstrainedRemoval::consider_vertex(TetMesh& mesh, Vec3 place) {
  _trial.before = mesh.worst_of(_trial.old_tets);
  _trial.after = _cones.optimise(mesh.measure(), place, _cones.worst(mesh.measure(), place, -1));
  if (_trial.after < bar_of(mesh, _trial.before)) return;
  mesh.add_vertex(place, mesh.corners(_trial.old_tets.front())[0]);
  if (is_good(mesh, _trial)) _found.push_back({_trial, place});
  mesh.drop_last_vertex();
}

/// An interior edge gets a vertex where the worst tetrahedron around it is best.
void OverConstrainedRemoval::split_edge(TetMesh& mesh, LocalIndex t, int edge) {
  if (!mesh.collect_edge_ring(t, edge, RingFilling::largest_ring, _edge_ring) || _edge_ring.ring.size() < 3)
    return;
  const auto& [start, end, tets, ring] = _edge_ring;
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
  consider_vertex(mesh, 0.5 * (mesh.point(start) + mesh.point(end)));
}

void OverConstrainedRemoval::fill_around_vertex(TetMesh& mesh, const std::vector<LocalIndex>& cavity) {
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
      if (is_inside(mesh.twin(4 * t + face))) continue;
      const auto& corner = mesh::tetrahedron_faces[face];
      const LocalIndex p = c[corner[0]], q = c[corner[2]], r = c[corner[1]];  // counter-clockwise from inside
      _trial.new_tets.push_back({p, q, r, middle});
      _cones.add(mesh.point(p), mesh.point(q), mesh.point(r));
    }
  }
  consider_vertex(mesh, place);
}

void OverConstrainedRemoval::split_neighbourhood(TetMesh& mesh, LocalIndex t) {
  _cavity.assign(1, t);
  for (int face = 0; face < 4; ++face) {
    if (const HalfFace other = mesh.twin(4 * t + face); other >= 0) _cavity.push_back(other >> 2);
  }
  const std::vector<LocalIndex> all = _cavity;
  fill_around_vertex(mesh, all);
  if (all.size() == 2) return;
  for (std::size_t i = 1; i < all.size(); ++i) fill_around_vertex(mesh, {t, all[i]});
}

void OverConstrainedRemoval::fill_stars(TetMesh& mesh, LocalIndex t) {
  std::vector<LocalIndex> both;
  const Corners corners = mesh.corners(t);
  for (const auto& [i, k] : mesh::tetrahedron_edges) {
    mesh.collect_star(corners[i], _cavity);
    both = _cavity;
    mesh.collect_star(corners[k], _cavity);
    for (const LocalIndex other : _cavity) {
      if (std::find(both.begin(), both.end(), other) == both.end()) both.push_back(other);
    }
    fill_around_vertex(mesh, both);
  }
  for (const LocalIndex v : corners) {
    mesh.collect_star(v, _cavity);
    fill_around_vertex(mesh, _cavity);
  }
}

bool OverConstrainedRemoval::is_good(const TetMesh& mesh, const CavityReplacement& cavity) {
  if (cavity.after < bar_of(mesh, cavity.before)) return false;
  return _count.added_by(mesh, cavity) < 0 && mesh.keeps_baffles(cavity) &&
         std::all_of(cavity.new_tets.begin(), cavity.new_tets.end(),
                     [&](const Corners& c) { return mesh.is_positive(c); }) &&
         _limits.allow_sizes(mesh, cavity);
}

}  // namespace aeroloom::improve
