#include "improve/cavity_insertion.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr int rounds = 3;            // of growing the cavity and placing the point
constexpr double least_gain = 1e-3;  // of quality: a smaller gain does not count as one

}  // namespace

bool CavityInsertion::contains(LocalIndex t) const {
  return std::find(_tets.begin(), _tets.end(), t) != _tets.end();
}

double CavityInsertion::cone_quality(const TetMesh& mesh, const std::array<LocalIndex, 3>& corners) const {
  return mesh.measure()(mesh.point(corners[0]), mesh.point(corners[1]), mesh.point(corners[2]), _point);
}

void CavityInsertion::collect_walls(const TetMesh& mesh) {
  _walls.clear();
  for (const LocalIndex t : _tets) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace side = 4 * t + f, other = mesh.mate(side);
      if (other >= 0 && contains(other >> 2)) continue;
      const auto& face = mesh::tetrahedron_faces[f];
      const Corners& c = mesh.corners(t);
      const std::array<LocalIndex, 3> corners{c[face[0]], c[face[2]], c[face[1]]};
      _walls.push_back({corners, side, cone_quality(mesh, corners)});
    }
  }
}

// The neighbour behind a wall joins when all walls it brings are better than that wall.
bool CavityInsertion::swallow_neighbour(const TetMesh& mesh, std::size_t wall) {
  const double floor = _walls[wall].quality;
  const HalfFace entry = mesh.mate(_walls[wall].side);
  if (entry < 0) return false;
  const LocalIndex t = entry >> 2;
  _grown.clear();
  for (int f = 0; f < 4; ++f) {
    const HalfFace side = 4 * t + f, other = mesh.mate(side);
    if (other >= 0 && contains(other >> 2)) continue;
    const auto& face = mesh::tetrahedron_faces[f];
    const Corners& c = mesh.corners(t);
    const std::array<LocalIndex, 3> corners{c[face[0]], c[face[2]], c[face[1]]};
    const double quality = cone_quality(mesh, corners);
    if (quality <= floor) return false;
    _grown.push_back({corners, side, quality});
  }
  std::erase_if(_walls, [&](const Wall& w) {
    const HalfFace other = mesh.mate(w.side);
    return other >= 0 && other >> 2 == t;
  });
  _walls.insert(_walls.end(), _grown.begin(), _grown.end());
  _tets.push_back(t);
  return true;
}

void CavityInsertion::grow(const TetMesh& mesh) {
  while (static_cast<int>(_tets.size()) < most_tets) {
    const auto worst = std::min_element(_walls.begin(), _walls.end(),
                                        [](const Wall& a, const Wall& b) { return a.quality < b.quality; });
    if (worst == _walls.end() || !swallow_neighbour(mesh, worst - _walls.begin())) return;
  }
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

bool CavityInsertion::propose(TetMesh& mesh, LocalIndex apex, Cavity& cavity) {
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
  double before = std::numeric_limits<double>::max();
  for (const LocalIndex t : _tets) before = std::min(before, mesh.quality(t));
  if (after < before + least_gain || !keeps_fixed_vertices(mesh)) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = after;
  cavity.old_tets = _tets;
  for (const Wall& w : _walls) cavity.new_tets.push_back({w.corners[0], w.corners[1], w.corners[2], apex});
  return true;
}

bool CavityInsertion::propose_around_vertex(TetMesh& mesh, LocalIndex vertex, Cavity& cavity) {
  mesh.collect_star(vertex, _tets);
  if (static_cast<int>(_tets.size()) >= most_tets) return false;
  _point = mesh.point(vertex);
  return propose(mesh, vertex, cavity);
}

bool CavityInsertion::propose_new_vertex(TetMesh& mesh, LocalIndex t, Cavity& cavity) {
  _tets.assign(1, t);
  const Corners& c = mesh.corners(t);
  _point = 0.25 * (mesh.point(c[0]) + mesh.point(c[1]) + mesh.point(c[2]) + mesh.point(c[3]));
  return propose(mesh, mesh.vertex_count(), cavity);
}

}  // namespace aeroloom::improve
