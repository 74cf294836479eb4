#include "improve/borders/piece_update.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/piece_room.hpp"

#include <algorithm>

namespace aeroloom::cavities {

using geometry::Vec3;

PieceUpdate::PieceUpdate(const mesh::Piece& old, const std::vector<mesh::SharedVertexKey>& vertex_keys)
    : _old(old), _vertex_keys(vertex_keys), _number(old.vertex_count(), -1), _named(old.vertex_count(), 0) {
  for (const mesh::LocalIndex v : old.shared_vertices) _named[v] = 1;
  _piece.id = old.id;
  _piece.kind = old.kind;
  _piece.region = old.region;
}

void PieceUpdate::leave(mesh::LocalIndex cell) {
  for (int k = 0; k < 4; ++k) _named[_old.cell(cell)[k]] = 1;
}

void PieceUpdate::keep(mesh::LocalIndex cell) {
  for (int k = 0; k < 4; ++k) _number[_old.cell(cell)[k]] = 0;
  _kept.push_back(cell);
}

mesh::Piece PieceUpdate::finish(std::span<const WireTet> tets, const std::vector<WireVertex>& vertices,
                                const std::vector<WireTriangle>& triangles) {
  number_old();
  add_vertices(tets, vertices);
  append_cells(tets);
  append_triangles(triangles);
  list_shared();
  mesh::shrink_to_fit(_piece);
  return std::move(_piece);
}

void PieceUpdate::number_old() {
  for (mesh::LocalIndex v = 0; v < _old.vertex_count(); ++v) {
    if (_number[v] < 0) continue;
    _number[v] = add(_old.point(v), _old.vertex_dimension[v], _old.vertex_entity[v],
                     _old.surface_numbers.empty() ? -1 : _old.surface_numbers[v]);
    if (_named[v]) _names.push_back({_vertex_keys[v], _number[v]});
  }
  sort_names();
}

mesh::LocalIndex PieceUpdate::add(Vec3 p, mesh::CadDimension dimension, std::int32_t entity,
                                  mesh::GlobalIndex surface_number) {
  const mesh::LocalIndex v = _piece.vertex_count();
  _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
  _piece.vertex_dimension.push_back(dimension);
  _piece.vertex_entity.push_back(entity);
  if (surface_number >= 0) _piece.surface_numbers.resize(v, -1);
  if (surface_number >= 0 || !_piece.surface_numbers.empty())
    _piece.surface_numbers.push_back(surface_number);
  return v;
}

void PieceUpdate::add_vertices(std::span<const WireTet> tets, const std::vector<WireVertex>& vertices) {
  std::vector<mesh::SharedVertexKey> wanted;
  for (const WireTet& t : tets) wanted.insert(wanted.end(), t.vertices.begin(), t.vertices.end());
  geometry::sort_unique(wanted);
  std::vector<const WireVertex*> missing;
  for (const WireVertex& v : vertices) {
    if (std::binary_search(wanted.begin(), wanted.end(), v.vertex_key) && find(v.vertex_key) < 0)
      missing.push_back(&v);
  }
  std::sort(missing.begin(), missing.end(),
            [](const WireVertex* a, const WireVertex* b) { return a->vertex_key < b->vertex_key; });
  std::vector<Named> names;
  for (const WireVertex* v : missing) {
    if (!names.empty() && v->vertex_key == names.back().vertex_key) continue;
    names.push_back({v->vertex_key, add(v->point, static_cast<mesh::CadDimension>(v->dimension), v->entity,
                                        v->surface_number)});
  }
  _names.insert(_names.end(), names.begin(), names.end());
  sort_names();
}

void PieceUpdate::append_cells(std::span<const WireTet> tets) {
  for (const mesh::LocalIndex c : _kept) {
    for (int k = 0; k < 4; ++k) _piece.cells.push_back(_number[_old.cell(c)[k]]);
  }
  for (const WireTet& t : tets) {
    for (const mesh::SharedVertexKey vertex_key : t.vertices) _piece.cells.push_back(find(vertex_key));
  }
}

void PieceUpdate::append_triangles(const std::vector<WireTriangle>& triangles) {
  for (const mesh::LocalIndex t : _kept_triangles) {
    for (int k = 0; k < 3; ++k) _piece.boundary.push_back(_number[_old.boundary_triangle(t)[k]]);
    _piece.triangle_face.push_back(_old.triangle_face[t]);
    _piece.triangle_patch.push_back(_old.triangle_patch[t]);
  }
  for (const WireTriangle& t : triangles) {
    for (const mesh::SharedVertexKey vertex_key : t.vertices) _piece.boundary.push_back(find(vertex_key));
    _piece.triangle_face.push_back(t.face);
    _piece.triangle_patch.push_back(t.patch);
  }
}

void PieceUpdate::sort_names() {
  std::sort(_names.begin(), _names.end(),
            [](const Named& a, const Named& b) { return a.vertex_key < b.vertex_key; });
}

mesh::LocalIndex PieceUpdate::find(mesh::SharedVertexKey vertex_key) const {
  const auto at = std::lower_bound(_names.begin(), _names.end(), vertex_key,
                                   [](const Named& n, mesh::SharedVertexKey t) { return n.vertex_key < t; });
  return at != _names.end() && at->vertex_key == vertex_key ? at->vertex : -1;
}

void PieceUpdate::list_shared() {
  std::sort(_names.begin(), _names.end(), [](const Named& a, const Named& b) { return a.vertex < b.vertex; });
  for (const Named& n : _names) {
    _piece.shared_vertices.push_back(n.vertex);
    _piece.shared_keys.push_back(n.vertex_key);
  }
}

}  // namespace aeroloom::cavities
