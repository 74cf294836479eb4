#include "improve/operations/cavity_insertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr int rounds = 3;            // of growing the cavity and placing the point; chosen, not measured
constexpr std::size_t patience = 6;  // tetrahedra taken in without a gain; chosen, not measured
constexpr double flat = 0.1;         // of the target: tetrahedra of less than about a degree
constexpr double least_gain = 1e-3;  // of quality: a smaller gain does not count as one
// Of the target: the least gain of a cavity that stays below the target. Without it, each new vertex would be
// followed by another.
constexpr double gain_when_moved = 0.05;
constexpr double gain_when_added = 0.12;

/// 0: the centre; then most of the way to the corners, the edges' middles, the faces' centres.
Vec3 start_in(const std::array<Vec3, 4>& p, int start) {
  constexpr double to_corner = 0.6, to_edge = 0.8, to_face = 0.8;  // not varied
  const Vec3 centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  if (start == 0) return centre;
  if (start < 5) return centre + to_corner * (p[start - 1] - centre);
  if (start < 11) {
    const auto& e = mesh::tetrahedron_edges[start - 5];
    return centre + to_edge * (0.5 * (p[e[0]] + p[e[1]]) - centre);
  }
  return centre - to_face / 3 * (p[start - 11] - centre);
}

}  // namespace

bool CavityInsertion::contains(LocalIndex t) const {
  return std::find(_tets.begin(), _tets.end(), t) != _tets.end();
}

void CavityInsertion::add_walls(const TetMesh& mesh, LocalIndex t) {
  for (int f = 0; f < 4; ++f) {
    const HalfFace side = 4 * t + f, other = mesh.twin(side);
    if (other >= 0 && contains(other >> 2)) continue;
    const auto& face = mesh::tetrahedron_faces[f];
    const Corners& c = mesh.corners(t);
    const std::array<LocalIndex, 3> corners{c[face[0]], c[face[2]], c[face[1]]};
    const double quality =
        mesh.measure()(mesh.point(corners[0]), mesh.point(corners[1]), mesh.point(corners[2]), _point);
    _walls.push_back({corners, side, quality});
  }
}

void CavityInsertion::collect_walls(const TetMesh& mesh) {
  _walls.clear();
  for (const LocalIndex t : _tets) add_walls(mesh, t);
}

void CavityInsertion::absorb(const TetMesh& mesh, LocalIndex t) {
  std::erase_if(_walls, [&](const Wall& w) { return mesh.twin(w.side) >= 0 && mesh.twin(w.side) >> 2 == t; });
  _tets.push_back(t);
  add_walls(mesh, t);
}

// Adds the neighbour across the worst face, whether that helps at once or not. If a face runs through the
// point, only both its tetrahedra together help. The best state on the way is kept.
void CavityInsertion::grow(const TetMesh& mesh) {
  std::size_t best_size = _tets.size();
  double best = -std::numeric_limits<double>::max();
  while (true) {
    const Wall* worst_open = nullptr;
    double worst = std::numeric_limits<double>::max();
    for (const Wall& w : _walls) {
      worst = std::min(worst, w.quality);
      const bool is_open = mesh.twin(w.side) >= 0 && w.quality < mesh.measure().target();
      if (is_open && (worst_open == nullptr || w.quality < worst_open->quality)) worst_open = &w;
    }
    if (worst > best) {
      best = worst;
      best_size = _tets.size();
    }
    if (worst_open == nullptr || static_cast<int>(_tets.size()) >= most_tets ||
        _tets.size() >= best_size + patience) {
      break;
    }
    absorb(mesh, mesh.twin(worst_open->side) >> 2);
  }
  _tets.resize(best_size);
  collect_walls(mesh);
}

// A fixed vertex must stay on the cavity's walls.
bool CavityInsertion::keeps_fixed_vertices(const TetMesh& mesh) const {
  for (const LocalIndex t : _tets) {
    for (const LocalIndex v : mesh.corners(t)) {
      if (!mesh.is_fixed(v)) continue;
      const auto has = [v](const Wall& w) {
        return std::find(w.corners.begin(), w.corners.end(), v) != w.corners.end();
      };
      if (std::none_of(_walls.begin(), _walls.end(), has)) return false;
    }
  }
  return true;
}

bool CavityInsertion::propose(TetMesh& mesh, LocalIndex apex, CavityReplacement& cavity) {
  double after = -1;
  for (int round = 0; round < rounds; ++round) {
    collect_walls(mesh);
    grow(mesh);
    after = std::numeric_limits<double>::max();
    _cones.clear();
    for (const Wall& w : _walls) {
      after = std::min(after, w.quality);
      _cones.add(mesh.point(w.corners[0]), mesh.point(w.corners[1]), mesh.point(w.corners[2]));
    }
    const double placed = _cones.optimise(mesh.measure(), _point, after);
    const bool gained = placed > after + least_gain;
    after = placed;
    if (!gained) break;
  }
  const double before = mesh.worst_of(_tets);
  const double wanted = apex == mesh.vertex_count() ? gain_when_added : gain_when_moved;
  if (after < std::min(before + wanted * mesh.measure().target(), mesh.measure().target())) return false;
  if (after < before + least_gain || !keeps_fixed_vertices(mesh)) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _tets;
  for (const Wall& w : _walls) cavity.new_tets.push_back({w.corners[0], w.corners[1], w.corners[2], apex});
  return true;
}

bool CavityInsertion::propose_around_vertex(TetMesh& mesh, LocalIndex vertex, CavityReplacement& cavity) {
  mesh.collect_star(vertex, _tets);
  if (static_cast<int>(_tets.size()) >= most_tets) return false;
  _point = mesh.point(vertex);
  return propose(mesh, vertex, cavity);
}

bool CavityInsertion::propose_new_vertex(TetMesh& mesh, LocalIndex t, int start, CavityReplacement& cavity) {
  _tets.assign(1, t);
  _point = start_in(mesh.points(t), start);
  if (propose(mesh, mesh.vertex_count(), cavity)) return true;
  const bool is_flat = mesh.quality(t) < flat * mesh.measure().target();
  return start == 0 && is_flat && start_at_neighbour(mesh, t) && propose(mesh, mesh.vertex_count(), cavity);
}

// Inside a tetrahedron that is flat on the boundary all cones are flat.
bool CavityInsertion::start_at_neighbour(const TetMesh& mesh, LocalIndex t) {
  _tets.assign(1, t);
  bool on_boundary = false;
  for (int f = 0; f < 4; ++f) {
    const HalfFace other = mesh.twin(4 * t + f);
    on_boundary = on_boundary || other < 0;
    if (other >= 0 && !contains(other >> 2)) _tets.push_back(other >> 2);
  }
  if (!on_boundary || _tets.size() < 2) return false;
  Vec3 sum;
  double weight = 0;
  for (const LocalIndex each : _tets) {
    const Corners& c = mesh.corners(each);
    const Vec3 p = mesh.point(c[0]);
    const double volume =
        std::abs(geometry::volume6(p, mesh.point(c[1]), mesh.point(c[2]), mesh.point(c[3])));
    for (const LocalIndex v : c) sum += 0.25 * volume * (mesh.point(v) - p);
    sum += volume * p;
    weight += volume;
  }
  if (!(weight > 0)) return false;
  _point = (1 / weight) * sum;
  return true;
}

}  // namespace aeroloom::improve
