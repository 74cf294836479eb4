#include "improve/pieces/over_constrained_trials.hpp"

#include "improve/limits/local_target.hpp"
#include "improve/operations/over_constrained_removal.hpp"
#include "improve/pieces/sweeps.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

/// Of the target: what a change may leave for the sweeps to improve. Chosen, not measured.
constexpr double least_fraction = 0.2;
constexpr int sweeps_after = 8;  // chosen, not measured

/// Whether two faces on the boundary enclose less than twice the target angle, which no two tetrahedra can
/// share.
bool is_forced(const TetMesh& mesh, LocalIndex t) {
  const double target = mesh.measure().target();
  const double cosine_of_twice = 1 - 2 * target * target;
  const Corners& c = mesh.corners(t);
  std::array<Vec3, 4> normals;
  int count = 0;
  for (int face = 0; face < 4; ++face) {
    if (!is_triangle(mesh.twin(4 * t + face))) continue;
    const auto& corner = mesh::tetrahedron_faces[face];
    const Vec3 a = mesh.point(c[corner[0]]);
    normals[count++] = normalized(cross(mesh.point(c[corner[1]]) - a, mesh.point(c[corner[2]]) - a));
  }
  for (int i = 1; i < count; ++i) {
    for (int k = 0; k < i; ++k) {
      if (-dot(normals[i], normals[k]) > cosine_of_twice) return true;
    }
  }
  return false;
}

}  // namespace

OverConstrainedTrials::State OverConstrainedTrials::examine(const TetMesh& mesh,
                                                            const std::vector<LocalIndex>& tets) {
  State state;
  for (const LocalIndex t : tets) state.add(mesh, t);
  return state;
}

OverConstrainedTrials::State OverConstrainedTrials::examine(const TetMesh& mesh) {
  State state;
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.is_alive(t)) state.add(mesh, t);
  }
  return state;
}

void OverConstrainedTrials::State::add(const TetMesh& mesh, LocalIndex t) {
  worst = std::min(worst, mesh.quality(t));
  bad += mesh.quality(t) < mesh.measure().target() ? 1 : 0;
  over_constrained += count_boundary_faces(mesh, t) > 1 ? 1 : 0;
}

bool OverConstrainedTrials::is_better(const State& now, const State& before, double target) {
  return now.over_constrained < before.over_constrained && now.bad <= before.bad &&
         now.worst >= std::min(before.worst, target);
}

std::int64_t OverConstrainedTrials::run(TetMesh& mesh) {
  if (_most == 0) return 0;
  std::int64_t removed = 0;
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (!mesh.is_alive(t) || count_boundary_faces(mesh, t) < 2 || is_forced(mesh, t)) continue;
    if (remove(mesh, t)) ++removed;
  }
  return removed;
}

bool OverConstrainedTrials::remove(TetMesh& mesh, LocalIndex t) {
  collect(mesh, t);
  const State before = examine(mesh, _tets);
  // If some miss the target already, sweeps would work on those for long.
  if (before.bad > 0) return false;
  const mesh::Piece start = copy(mesh);
  const LocalTarget narrow_target(start, mesh.measure());
  const LocalTarget everywhere(mesh.measure());
  const ChangeLimits limits(_field, &narrow_target, _effort);
  OverConstrainedRemoval removal(limits, least_fraction);
  mesh::Piece piece = start;
  TetMesh untouched(piece, mesh.measure());
  const std::vector<OverConstrainedChange>& found = removal.find(untouched, 0);
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(_most), found.size()); ++i) {
    piece = start;
    TetMesh copied(piece, mesh.measure());
    const std::vector<LocalIndex>& fresh = removal.apply(copied, found[i]);
    Sweeps sweeps(copied, _effort == Effort::full ? everywhere : narrow_target, limits, _effort);
    sweeps.follow_removal(fresh);
    sweeps.run(sweeps_after);
    if (!is_better(examine(copied), before, mesh.measure().target())) continue;
    copied.finish();
    put_back(mesh, piece, copied.origin());
    return true;
  }
  return false;
}

// The tetrahedron comes first.
void OverConstrainedTrials::collect(TetMesh& mesh, LocalIndex t) {
  for (const LocalIndex v : _vertices) _number[v] = -1;
  _number.resize(mesh.vertex_count(), -1);
  _tets.assign(1, t);
  _vertices.assign(mesh.corners(t).begin(), mesh.corners(t).end());
  _inside.assign(4, 0);
  for (std::size_t i = 0; i < _vertices.size(); ++i) _number[_vertices[i]] = static_cast<LocalIndex>(i);
  std::size_t inner_end = 0;
  for (int ring = 0; ring < 2; ++ring) {
    const std::size_t begin = inner_end;
    inner_end = _vertices.size();
    for (std::size_t i = begin; i < inner_end; ++i) {
      mesh.collect_star(_vertices[i], _star);
      _tets.insert(_tets.end(), _star.begin(), _star.end());
      for (const LocalIndex tet : _star) {
        for (const LocalIndex v : mesh.corners(tet)) {
          if (_number[v] >= 0) continue;
          _number[v] = static_cast<LocalIndex>(_vertices.size());
          _vertices.push_back(v);
        }
      }
    }
  }
  std::sort(_tets.begin() + 1, _tets.end());
  _tets.erase(std::unique(_tets.begin() + 1, _tets.end()), _tets.end());
  // It is not among the stars where it touches the other tetrahedra of its piece in vertices and edges alone.
  _tets.erase(std::remove(_tets.begin() + 1, _tets.end(), t), _tets.end());
  _inside.assign(_vertices.size(), 0);
  for (std::size_t i = 0; i < _vertices.size(); ++i)
    _inside[i] = i < inner_end && !mesh.is_fixed(_vertices[i]);
}

mesh::Piece OverConstrainedTrials::copy(const TetMesh& mesh) const {
  mesh::Piece piece;
  for (std::size_t i = 0; i < _vertices.size(); ++i) {
    const LocalIndex v = _vertices[i];
    const Vec3 p = mesh.point(v);
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    piece.vertex_dimension.push_back(mesh.dimension(v));
    piece.vertex_entity.push_back(mesh.entity(v));
    if (_inside[i]) continue;
    piece.shared_vertices.push_back(static_cast<LocalIndex>(i));
  }
  for (const LocalIndex t : _tets) {
    for (const LocalIndex v : mesh.corners(t)) piece.cells.push_back(_number[v]);
    for (int face = 0; face < 4; ++face) {
      const HalfFace other = mesh.twin(4 * t + face);
      if (!is_triangle(other)) continue;
      for (const LocalIndex v : mesh.triangle(triangle_of(other))) piece.boundary.push_back(_number[v]);
      piece.triangle_face.push_back(mesh.face_of(triangle_of(other)));
      piece.triangle_patch.push_back(0);
    }
  }
  return piece;
}

void OverConstrainedTrials::put_back(TetMesh& mesh, const mesh::Piece& piece,
                                     const std::vector<LocalIndex>& origin) {
  std::vector<LocalIndex> named(piece.vertex_count());
  const LocalIndex like =
      *std::max_element(_vertices.begin(), _vertices.end(),
                        [&](LocalIndex a, LocalIndex b) { return mesh.dimension(a) < mesh.dimension(b); });
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const auto before = static_cast<std::size_t>(origin[v]);
    const bool stays = before < _vertices.size() && mesh.point(_vertices[before]) == piece.point(v);
    named[v] = stays ? _vertices[before] : mesh.add_vertex(piece.point(v), like);
  }
  const auto key_of = [](Corners c) {
    std::sort(c.begin(), c.end());
    return c;
  };
  std::vector<Corners> before, after;
  for (const LocalIndex t : _tets) before.push_back(key_of(mesh.corners(t)));
  std::sort(before.begin(), before.end());
  CavityReplacement cavity;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    const Corners corners{named[c[0]], named[c[1]], named[c[2]], named[c[3]]};
    after.push_back(key_of(corners));
    if (!std::binary_search(before.begin(), before.end(), after.back())) cavity.new_tets.push_back(corners);
  }
  std::sort(after.begin(), after.end());
  for (const LocalIndex t : _tets) {
    if (!std::binary_search(after.begin(), after.end(), key_of(mesh.corners(t))))
      cavity.old_tets.push_back(t);
  }
  mesh.replace(cavity, _placed);
}

}  // namespace aeroloom::improve
