/// The boundary triangles of a TetMesh, and the tetrahedra around edges.
#include "improve/tets/tet_mesh.hpp"

#include <algorithm>

namespace aeroloom::improve {

using mesh::tetrahedron_edges;
using mesh::tetrahedron_faces;

namespace {

// For each edge, the two other vertices in the order that makes (start, end, from, to) positive.
constexpr int others[6][2] = {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}};

}  // namespace

// The open side of a face that is a boundary triangle gets the triangle's number, if it may change.
void TetMesh::match_triangles(bool boundary_may_change) {
  struct Named {
    std::array<LocalIndex, 3> key;
    LocalIndex triangle;
  };
  std::vector<Named> named(_piece.boundary.size() / 3);
  for (std::size_t i = 0; i < named.size(); ++i) {
    const LocalIndex* v = _piece.boundary.data() + 3 * i;
    named[i] = {sorted(v[0], v[1], v[2]), static_cast<LocalIndex>(i)};
  }
  const auto before = [](const Named& a, const Named& b) { return a.key < b.key; };
  std::sort(named.begin(), named.end(), before);
  std::vector<std::uint8_t> matched(named.size(), 0);
  for (std::size_t h = 0; h < _twins.size() && !named.empty(); ++h) {
    if (_twins[h] >= 0) continue;
    const Named wanted{face_key(static_cast<HalfFace>(h)), 0};
    const auto found = std::lower_bound(named.begin(), named.end(), wanted, before);
    if (found == named.end() || found->key != wanted.key) continue;
    matched[static_cast<std::size_t>(found - named.begin())] = 1;
    if (boundary_may_change) _twins[h] = -2 - found->triangle;
  }
  std::vector<std::array<LocalIndex, 3>> keys;
  std::vector<LocalIndex> triangles;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (matched[i] || (!keys.empty() && keys.back() == named[i].key)) continue;
    keys.push_back(named[i].key);
    triangles.push_back(named[i].triangle);
  }
  if (!keys.empty()) part_at_baffles(keys, triangles, boundary_may_change);
}

// Triangles that no open side has lie between two tetrahedra, or beside none.
void TetMesh::part_at_baffles(std::span<const std::array<LocalIndex, 3>> keys,
                              std::span<const LocalIndex> triangles, bool boundary_may_change) {
  std::vector<std::uint8_t> there(_incident.size(), 0);
  for (const auto& key : keys) {
    for (const LocalIndex v : key) there[v] = 1;
  }
  for (std::size_t h = 0; h < _twins.size(); ++h) {
    const HalfFace other = _twins[h];
    if (other < static_cast<HalfFace>(h)) continue;
    const auto key = face_key(static_cast<HalfFace>(h));
    if (!there[key[0]] || !there[key[1]] || !there[key[2]]) continue;
    const auto found = std::lower_bound(keys.begin(), keys.end(), key);
    if (found == keys.end() || *found != key) continue;
    _twins[h] = _twins[other] = boundary_may_change ? -2 - triangles[found - keys.begin()] : -1;
    _baffles.push_back(key);
  }
  std::sort(_baffles.begin(), _baffles.end());
}

bool TetMesh::keeps_baffles(const CavityReplacement& cavity) const {
  if (_baffles.empty()) return true;
  const auto sides_at_baffles = [&](const auto& tets, const auto& corners_of) {
    std::vector<std::array<LocalIndex, 3>> sides;
    for (const auto& tet : tets) {
      const Corners& c = corners_of(tet);
      for (const auto& face : tetrahedron_faces) {
        const auto key = sorted(c[face[0]], c[face[1]], c[face[2]]);
        if (std::binary_search(_baffles.begin(), _baffles.end(), key)) sides.push_back(key);
      }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
  };
  return sides_at_baffles(cavity.old_tets, [&](LocalIndex t) -> const Corners& { return _cells[t]; }) ==
         sides_at_baffles(cavity.new_tets, [](const Corners& c) -> const Corners& { return c; });
}

std::array<LocalIndex, 3> TetMesh::triangle(LocalIndex i) const {
  const LocalIndex* v = _piece.boundary.data() + 3 * static_cast<std::size_t>(i);
  return {v[0], v[1], v[2]};
}

bool TetMesh::is_free_triangle(LocalIndex i) const {
  const auto v = triangle(i);
  return v[0] >= 0 && !(is_shared(v[0]) && is_shared(v[1]) && is_shared(v[2]));
}

bool TetMesh::on_same_face(LocalIndex i, LocalIndex k) const {
  return _piece.triangle_face[i] == _piece.triangle_face[k] &&
         _piece.triangle_patch[i] == _piece.triangle_patch[k];
}

// A face that is open from now on is the boundary's triangle `triangle`, as seen from outside.
void TetMesh::open_boundary(const FaceRecord& record, LocalIndex triangle) {
  if (record.side < 0) throw std::logic_error("improve: a boundary triangle without a tetrahedron");
  _twins[record.side] = -2 - triangle;
  const auto& face = tetrahedron_faces[record.side & 3];
  const Corners& c = _cells[record.side >> 2];
  for (int k = 0; k < 3; ++k) _piece.boundary[3 * static_cast<std::size_t>(triangle) + k] = c[face[k]];
}

// Pairs stay, single faces are the new boundary.
void TetMesh::match_boundary(const CavityReplacement& cavity) {
  std::size_t kept = 0, used = 0;
  for (std::size_t i = 0; i < _faces.size(); ++i) {
    if (i + 1 < _faces.size() && _faces[i].key == _faces[i + 1].key) {
      _faces[kept++] = _faces[i++];
      _faces[kept++] = _faces[i];
    } else if (used < cavity.old_triangles.size()) {
      open_boundary(_faces[i], cavity.old_triangles[used++]);
    } else {
      throw std::logic_error("improve: a cavity opens more boundary than it had");
    }
  }
  _faces.resize(kept);
  _changed_triangles += static_cast<std::int64_t>(cavity.old_triangles.size());
  for (; used < cavity.old_triangles.size(); ++used) {
    _piece.boundary[3 * static_cast<std::size_t>(cavity.old_triangles[used])] = -1;
    _dead_triangles = true;
  }
}

bool TetMesh::collect_fan(LocalIndex t, int edge, int most, Fan& fan) const {
  fan.start = _cells[t][tetrahedron_edges[edge][0]];
  fan.end = _cells[t][tetrahedron_edges[edge][1]];
  LocalIndex from = _cells[t][others[edge][0]], to = _cells[t][others[edge][1]];
  // Back to the first tetrahedron, then forward through all of them.
  LocalIndex current = t;
  for (int steps = 0;; ++steps) {
    const HalfFace previous = _twins[4 * current + local_vertex(current, to)];
    if (is_triangle(previous)) {
      fan.triangles[0] = triangle_of(previous);
      break;
    }
    if (previous < 0 || steps == most) return false;
    to = from;
    current = previous >> 2;
    from = _cells[current][previous & 3];
    if (current == t) return false;
  }
  fan.tets.clear();
  fan.ring.assign(1, from);
  while (true) {
    if (static_cast<int>(fan.tets.size()) == most) return false;
    fan.tets.push_back(current);
    fan.ring.push_back(to);
    const HalfFace next = _twins[4 * current + local_vertex(current, from)];
    if (is_triangle(next)) {
      fan.triangles[1] = triangle_of(next);
      return true;
    }
    if (next < 0) return false;
    from = to;
    current = next >> 2;
    to = _cells[current][next & 3];
  }
}

bool TetMesh::collect_edge_ring(LocalIndex t, int edge, int most, EdgeRing& edge_ring) const {
  edge_ring.start = _cells[t][tetrahedron_edges[edge][0]];
  edge_ring.end = _cells[t][tetrahedron_edges[edge][1]];
  LocalIndex from = _cells[t][others[edge][0]], to = _cells[t][others[edge][1]];
  edge_ring.tets.clear();
  edge_ring.ring.clear();
  LocalIndex current = t;
  do {
    if (static_cast<int>(edge_ring.tets.size()) == most) return false;
    edge_ring.tets.push_back(current);
    edge_ring.ring.push_back(from);
    const HalfFace next = _twins[4 * current + local_vertex(current, from)];
    if (next < 0) return false;
    from = to;
    current = next >> 2;
    to = _cells[current][next & 3];
  } while (current != t);
  return true;
}

}  // namespace aeroloom::improve
