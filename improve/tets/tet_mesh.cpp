#include "improve/tets/tet_mesh.hpp"

#include "mesh/data/piece_faces.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace aeroloom::improve {

using mesh::tetrahedron_faces;

TetMesh::TetMesh(mesh::Piece& piece, const mesh::TetQuality& measure, bool boundary_may_change)
    : _piece(piece), _measure(measure) {
  _original_count = piece.cell_count();
  _cells.resize(_original_count);
  _quality.resize(_original_count);
  for (LocalIndex t = 0; t < _original_count; ++t) {
    std::copy_n(piece.cell(t), 4, _cells[t].begin());
    _quality[t] = quality_of(_cells[t]);
  }
  piece.cells.clear();
  piece.cells.shrink_to_fit();
  _incident.assign(piece.vertex_count(), -1);
  for (LocalIndex t = _original_count - 1; t >= 0; --t) {
    for (const LocalIndex v : _cells[t]) _incident[v] = t;
  }
  _tet_mark.assign(_original_count, 0);
  match_all_faces();
  match_triangles(boundary_may_change);
  fix_vertices();
}

std::array<LocalIndex, 3> TetMesh::face_key(HalfFace h) const {
  const auto& face = tetrahedron_faces[h & 3];
  const Corners& c = _cells[h >> 2];
  return sorted(c[face[0]], c[face[1]], c[face[2]]);
}

// Each face is in a list of its lowest vertex from when its first side comes; the lists are short.
void TetMesh::match_all_faces() {
  struct Face {
    std::uint64_t upper;  // the two higher vertices
    HalfFace side;
    std::int32_t next;
  };
  const std::size_t sides = 4 * _cells.size();
  _twins.assign(sides, -1);
  std::vector<std::int32_t> first(_incident.size(), -1);
  std::vector<Face> faces;
  faces.reserve(sides / 2 + sides / 16);  // a face has two sides, but for those of the boundary
  for (std::size_t h = 0; h < sides; ++h) {
    const auto side = static_cast<HalfFace>(h);
    const auto key = face_key(side);
    const std::uint64_t upper = static_cast<std::uint64_t>(key[1]) << 32 | static_cast<std::uint32_t>(key[2]);
    std::int32_t at = first[key[0]];
    while (at >= 0 && faces[at].upper != upper) at = faces[at].next;
    if (at < 0) {
      faces.push_back({upper, side, first[key[0]]});
      first[key[0]] = static_cast<std::int32_t>(faces.size() - 1);
    } else if (_twins[faces[at].side] >= 0) {
      throw std::logic_error("improve: three tetrahedra share a face");
    } else {
      _twins[side] = faces[at].side;
      _twins[faces[at].side] = side;
    }
  }
}

void TetMesh::fix_vertices() {
  _fixed.assign(_incident.size(), 0);
  for (std::size_t v = 0; v < _fixed.size(); ++v)
    _fixed[v] = is_on_boundary(_piece.vertex_dimension[v]) || _incident[v] < 0;
  _shared.assign(_incident.size(), 0);
  for (const LocalIndex v : _piece.shared_vertices) _fixed[v] = _shared[v] = 1;
  for (const LocalIndex v : _piece.boundary) _fixed[v] = 1;
  for (const auto& triangle : _baffles) {
    for (const LocalIndex v : triangle) _shared[v] = 1;
  }
  for (std::size_t h = 0; h < _twins.size(); ++h) {
    if (_twins[h] >= 0) continue;
    for (const LocalIndex v : face_key(static_cast<HalfFace>(h))) _fixed[v] = 1;
  }
}

double TetMesh::worst_of(std::span<const LocalIndex> tets) const {
  double worst = std::numeric_limits<double>::max();
  for (const LocalIndex t : tets) worst = std::min(worst, _quality[t]);
  return worst;
}

int TetMesh::local_vertex(LocalIndex t, LocalIndex v) const {
  const Corners& c = _cells[t];
  return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : 3;
}

void TetMesh::next_mark() {
  if (++_mark == 0) {
    std::fill(_tet_mark.begin(), _tet_mark.end(), 0);
    _mark = 1;
  }
}

void TetMesh::collect_star(LocalIndex vertex, std::vector<LocalIndex>& tets) {
  next_mark();
  tets.assign(1, _incident[vertex]);
  _tet_mark[tets[0]] = _mark;
  for (std::size_t i = 0; i < tets.size(); ++i) {
    const LocalIndex t = tets[i];
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = _twins[4 * t + f];
      if (_cells[t][f] == vertex || other < 0 || _tet_mark[other >> 2] == _mark) continue;
      _tet_mark[other >> 2] = _mark;
      tets.push_back(other >> 2);
    }
  }
}

void TetMesh::take_slots(const CavityReplacement& cavity, std::vector<LocalIndex>& placed) {
  placed.clear();
  for (std::size_t i = 0; i < cavity.new_tets.size(); ++i) {
    LocalIndex slot = slot_count();
    if (i < cavity.old_tets.size()) {
      slot = cavity.old_tets[i];
    } else {
      const LocalIndex origin = cavity.old_tets[0];
      _place.push_back(origin < _original_count ? origin : _place[origin - _original_count]);
      _cells.emplace_back();
      _quality.push_back(0);
      _tet_mark.push_back(0);
      _twins.insert(_twins.end(), 4, -1);
    }
    _cells[slot] = cavity.new_tets[i];
    _quality[slot] = quality_of(cavity.new_tets[i]);
    placed.push_back(slot);
  }
  for (std::size_t i = cavity.new_tets.size(); i < cavity.old_tets.size(); ++i)
    _cells[cavity.old_tets[i]][0] = -1;
}

void TetMesh::match_cavity_faces() {
  if (_faces.size() % 2 != 0)
    throw std::logic_error("improve: a cavity and its filling differ in their faces");
  for (std::size_t i = 0; i < _faces.size(); i += 2) {
    const FaceRecord &a = _faces[i], &b = _faces[i + 1];
    if (i + 3 < _faces.size() && a.side < 0 && b.side < 0 && _faces[i + 3].key == a.key) {
      for (const std::size_t k : {i + 2, i + 3})
        _twins[_faces[k].side] = a.side;  // on both sides of a baffle
      i += 2;
      continue;
    }
    if (a.key != b.key || (a.outer && b.outer)) {
      throw std::logic_error("improve: a cavity and its filling differ in their faces");
    }
    if (a.side >= 0) _twins[a.side] = b.side;
    if (b.side >= 0) _twins[b.side] = a.side;
  }
}

void TetMesh::replace(const CavityReplacement& cavity, std::vector<LocalIndex>& placed) {
  next_mark();
  for (const LocalIndex t : cavity.old_tets) _tet_mark[t] = _mark;
  _faces.clear();
  const auto goes = [&](LocalIndex triangle) {
    return std::find(cavity.old_triangles.begin(), cavity.old_triangles.end(), triangle) !=
           cavity.old_triangles.end();
  };
  for (const LocalIndex t : cavity.old_tets) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = _twins[4 * t + f];
      if (other >= 0 && _tet_mark[other >> 2] == _mark) continue;
      if (is_triangle(other) && goes(triangle_of(other))) continue;
      _faces.push_back({face_key(4 * t + f), other, true});
    }
  }
  _cavity_vertices.clear();
  for (const LocalIndex t : cavity.old_tets) {
    for (const LocalIndex v : _cells[t]) {
      _incident[v] = -1;
      _cavity_vertices.push_back(v);
    }
  }
  take_slots(cavity, placed);
  for (const LocalIndex t : placed) {
    for (int f = 0; f < 4; ++f) _faces.push_back({face_key(4 * t + f), 4 * t + f, false});
    for (const LocalIndex v : _cells[t]) _incident[v] = t;
  }
  std::sort(_faces.begin(), _faces.end(), [](const FaceRecord& a, const FaceRecord& b) {
    return a.key != b.key ? a.key < b.key : a.side < b.side;
  });
  if (!cavity.old_triangles.empty()) {
    // A tetrahedron that goes without another in its place leaves its vertices to its neighbours.
    for (const FaceRecord& record : _faces) {
      if (record.side < 0) continue;
      for (const LocalIndex v : record.key) _incident[v] = record.side >> 2;
    }
    match_boundary(cavity);
  }
  match_cavity_faces();
  for (const LocalIndex v : _cavity_vertices) {
    if (_incident[v] < 0) _fixed[v] = 0;
  }
}

void TetMesh::move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star) {
  _piece.set_point(v, p);
  for (const LocalIndex t : star) _quality[t] = quality_of(_cells[t]);
}

void TetMesh::move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star,
                          std::span<const double> qualities) {
  _piece.set_point(v, p);
  for (std::size_t i = 0; i < star.size(); ++i) _quality[star[i]] = qualities[i];
}

LocalIndex TetMesh::add_vertex(Vec3 p, LocalIndex like) {
  const LocalIndex v = vertex_count();
  _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
  _piece.vertex_dimension.push_back(mesh::CadDimension::region);
  _piece.vertex_entity.push_back(
      _piece.vertex_dimension[like] == mesh::CadDimension::region ? _piece.vertex_entity[like] : 0);
  if (!_piece.surface_numbers.empty()) _piece.surface_numbers.push_back(-1);
  _incident.push_back(-1);
  _fixed.push_back(0);
  _shared.push_back(0);
  return v;
}

void TetMesh::drop_last_vertex() {
  _piece.coordinates.resize(_piece.coordinates.size() - 3);
  _piece.vertex_dimension.pop_back();
  _piece.vertex_entity.pop_back();
  if (!_piece.surface_numbers.empty()) _piece.surface_numbers.pop_back();
  _incident.pop_back();
  _fixed.pop_back();
  _shared.pop_back();
}

void TetMesh::finish() {
  order_cells();
  if (_dead_triangles)
    mesh::keep_boundary_triangles(_piece, [&](LocalIndex i) { return *_piece.boundary_triangle(i) >= 0; });
  remove_unused_vertices();
}

// Slots beyond the original ones are merged in after the original slot their cavity had, in order of their
// making.
void TetMesh::order_cells() {
  std::vector<LocalIndex> added(_place.size());
  std::iota(added.begin(), added.end(), 0);
  std::stable_sort(added.begin(), added.end(),
                   [&](LocalIndex a, LocalIndex b) { return _place[a] < _place[b]; });
  std::vector<LocalIndex>& cells = _piece.cells;
  cells.reserve(4 * _cells.size());
  const auto emit = [&](LocalIndex slot) {
    if (is_alive(slot)) cells.insert(cells.end(), _cells[slot].begin(), _cells[slot].end());
  };
  auto next = added.begin();
  for (LocalIndex t = 0; t < _original_count; ++t) {
    emit(t);
    for (; next != added.end() && _place[*next] == t; ++next) emit(_original_count + *next);
  }
}

// Vertices that only replaced tetrahedra used.
void TetMesh::remove_unused_vertices() {
  std::vector<LocalIndex> renumbered(_incident.size(), -1);
  LocalIndex kept = 0;
  for (LocalIndex v = 0; v < vertex_count(); ++v) {
    if (!is_used(v) && !is_fixed(v)) continue;
    _origin.push_back(v);
    renumbered[v] = kept;
    _piece.set_point(kept, _piece.point(v));
    _piece.vertex_dimension[kept] = _piece.vertex_dimension[v];
    _piece.vertex_entity[kept] = _piece.vertex_entity[v];
    if (!_piece.surface_numbers.empty()) _piece.surface_numbers[kept] = _piece.surface_numbers[v];
    ++kept;
  }
  if (kept == vertex_count()) return;
  _piece.coordinates.resize(3 * static_cast<std::size_t>(kept));
  _piece.vertex_dimension.resize(kept);
  _piece.vertex_entity.resize(kept);
  if (!_piece.surface_numbers.empty()) _piece.surface_numbers.resize(kept);
  for (auto* indices : {&_piece.cells, &_piece.boundary, &_piece.shared_vertices}) {
    for (LocalIndex& v : *indices) v = renumbered[v];
  }
}

}  // namespace aeroloom::improve
