#include "layers/layer_piece.hpp"

#include "layers/column_heights.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace aeroloom::layers {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

namespace {

using Triangle = std::array<LocalIndex, 3>;

Triangle corners_of(const Piece& wall, LocalIndex t) {
  const LocalIndex* v = wall.cell(t);
  return {v[0], v[1], v[2]};
}

class LayerPieceMaker {
public:
  LayerPieceMaker(const LayeredPiece& source, const std::vector<std::uint8_t>& shared)
      : _source(source),
        _shared(shared),
        _foot(source.wall.vertex_count(), -1),
        _first(source.columns.column_count(), -1) {
    _piece.region = source.region;
  }

  Piece make(TriangleRange range) {
    auto lateral = std::lower_bound(
        _source.laterals.begin(), _source.laterals.end(), 3 * range.begin,
        [](const LateralEdge& edge, std::int32_t half_edge) { return edge.half_edge < half_edge; });
    const std::vector<FanFace>& fans = _source.columns.fan_faces;
    std::size_t fan = 0;
    for (LocalIndex t = range.begin; t < range.end; ++t) {
      const std::int32_t layers = _source.layers_over(t);
      if (layers > 0) add_triangle(t, layers);
      for (; fan < fans.size() && fans[fan].triangle <= t; ++fan) {
        if (fans[fan].triangle == t && _source.layers_over(fans[fan]) > 0)
          add_fan(static_cast<std::int32_t>(fan));
      }
      for (; lateral != _source.laterals.end() && lateral->half_edge < 3 * (t + 1); ++lateral)
        add_lateral(*lateral);
    }
    _piece.layers = std::move(_of_tetrahedra);
    _piece.layers.insert(_piece.layers.end(), _of_pyramids.begin(), _of_pyramids.end());
    _piece.layers.insert(_piece.layers.end(), _of_prisms.begin(), _of_prisms.end());
    _piece.layers.insert(_piece.layers.end(), _of_hexahedra.begin(), _of_hexahedra.end());
    return std::move(_piece);
  }

private:
  std::int32_t count(std::int32_t column) const {
    return _source.columns.counts[_source.columns.vertex_of(column)];
  }
  /// Node k of a column, or its last.
  LocalIndex at(std::int32_t column, std::int32_t k) const {
    const std::int32_t level = std::min(k, count(column));
    return level == 0 ? _foot[_source.columns.vertex_of(column)] : _first[column] + level - 1;
  }

  void add_triangle(LocalIndex t, std::int32_t layers) {
    const std::array<std::int32_t, 3>& columns = _source.columns.corner_columns[t];
    for (const std::int32_t each : columns) add_column(each);
    for (const std::int32_t each : columns) _piece.boundary.push_back(at(each, 0));
    _piece.triangle_face.push_back(_source.wall.triangle_face[t]);
    _piece.triangle_patch.push_back(_source.wall.triangle_patch[t]);
    if (_source.elements == LayerElements::tets) return add_tetrahedra(columns, layers);
    const std::array<std::int32_t, 3> turned{columns[0], columns[2], columns[1]};  // seen from the fluid
    const LayersOverTriangle over = _source.layers_of(turned);
    for (std::int32_t k = 1; k <= layers; ++k) {
      visit_layer(over, k, [&](mesh::CellShape shape, const auto& nodes) {
        add_cell(shape, k, nodes, [&](int corner) { return turned[static_cast<std::size_t>(corner)]; });
      });
    }
  }

  /// The cells over a face of a fan, with the apex on top of a sector.
  void add_fan(std::int32_t f) {
    const FanFace& face = _source.columns.fan_faces[f];
    for (const std::int32_t column : face.columns) {
      if (column >= 0) add_column(column);
    }
    const LayersOverFan over = _source.layers_of(face);
    const auto column_at = [&](int corner) { return face.columns[static_cast<std::size_t>(corner)]; };
    const std::int32_t most = std::max(over.counts[0], over.counts[1]);
    for (std::int32_t k = 1; k <= most; ++k) {
      visit_layer(over, k,
                  [&](mesh::CellShape shape, const auto& nodes) { add_cell(shape, k, nodes, column_at); });
    }
    if (const LocalIndex apex = _source.layout.apex_of_face[f]; apex >= 0) {
      for (const std::int32_t column : face.columns) _piece.pyramids.push_back(at(column, most));
      _piece.pyramids.push_back(
          add_vertex(_source.cap.point(apex), mesh::CadDimension::region, _source.region));
      share(_piece.pyramids.back(), mesh::running_key(_source.numbers[apex]));
      _of_pyramids.push_back(static_cast<std::int16_t>(most));
    }
    for (const int end : {0, 1}) {
      if (face.end_faces[end] >= 0) add_end(face, end);
    }
  }

  /// The faces of a sector's cells on the plane that it ends on.
  void add_end(const FanFace& face, int end) {
    const std::int32_t a = face.columns[2 * end], b = face.columns[2 * end + 1];
    for (std::int32_t k = 1; k <= count(a); ++k) {
      if (k == 1) {
        _piece.boundary.insert(_piece.boundary.end(), {at(a, 0), at(b, 1), at(a, 1)});
        _piece.triangle_face.push_back(face.end_faces[end]);
        _piece.triangle_patch.push_back(face.end_patches[end]);
        continue;
      }
      _piece.quads.insert(_piece.quads.end(), {at(a, k - 1), at(b, k - 1), at(b, k), at(a, k)});
      _piece.quad_face.push_back(face.end_faces[end]);
      _piece.quad_patch.push_back(face.end_patches[end]);
    }
  }

  LocalIndex add_vertex(Vec3 p, mesh::CadDimension dimension, std::int32_t entity) {
    _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
    _piece.vertex_dimension.push_back(dimension);
    _piece.vertex_entity.push_back(entity);
    return _piece.vertex_count() - 1;
  }
  void share(LocalIndex vertex, mesh::SharedVertexKey key) {
    _piece.shared_vertices.push_back(vertex);
    _piece.shared_keys.push_back(key);
  }

  /// The nodes of a column, and its vertex, where they are not there yet.
  void add_column(std::int32_t column) {
    const LocalIndex v = _source.columns.vertex_of(column);
    const std::int32_t top = _source.columns.counts[v];
    const LocalIndex end = _source.layout.vertex_of_column[column];
    if (_foot[v] < 0) {
      _foot[v] = add_vertex(top == 0 ? _source.cap.point(end) : _source.wall.point(v),
                            _source.wall.vertex_dimension[v], _source.wall.vertex_entity[v]);
      if (top == 0) {
        share(_foot[v], mesh::running_key(_source.numbers[end]));
      } else if (!_source.foot_keys.empty() && _source.foot_keys[v] != no_foot_key) {
        share(_foot[v], _source.foot_keys[v]);
      } else if (_shared[v] != 0) {
        const bool several = _source.columns.columns_at(v) > 1;
        share(_foot[v],
              several ? wall_vertex_key(_source.wall_numbers[v]) : mesh::layer_key(_source.numbers[end], 0));
      }
    }
    if (top == 0 || _first[column] >= 0) return;
    _first[column] = _piece.vertex_count();
    for_each_node(_source.wall, _source.columns, column, [&](std::int32_t k, Vec3 p) {
      const LocalIndex here =
          add_vertex(k == top ? _source.cap.point(end) : p, mesh::CadDimension::region, _source.region);
      if (k < top && !_shared[v]) return;
      share(here,
            k == top ? mesh::running_key(_source.numbers[end]) : mesh::layer_key(_source.numbers[end], k));
    });
  }

  /// `column_at(corner)` tells columns.
  template <class Nodes, class ColumnAt>
  void add_cell(mesh::CellShape shape, std::int32_t k, const Nodes& nodes, const ColumnAt& column_at) {
    std::vector<LocalIndex>& to = shape == mesh::CellShape::tetrahedron ? _piece.cells
                                  : shape == mesh::CellShape::pyramid   ? _piece.pyramids
                                  : shape == mesh::CellShape::prism     ? _piece.prisms
                                                                        : _piece.hexahedra;
    for (const ColumnNode& each : nodes) to.push_back(at(column_at(each.corner), each.level));
    std::vector<std::int16_t>& layers = shape == mesh::CellShape::tetrahedron ? _of_tetrahedra
                                        : shape == mesh::CellShape::pyramid   ? _of_pyramids
                                        : shape == mesh::CellShape::prism     ? _of_prisms
                                                                              : _of_hexahedra;
    layers.push_back(static_cast<std::int16_t>(k));
  }

  /// Corners by the numbers of their columns, the largest first: in this order columns rise.
  template <std::size_t Count>
  std::array<int, Count> order_of_rise(const std::array<std::int32_t, Count>& columns) const {
    const auto number = [&](int i) {
      return _source.numbers[_source.layout.vertex_of_column[columns[static_cast<std::size_t>(i)]]];
    };
    std::array<int, Count> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return number(a) > number(b); });
    return order;
  }

  void add_tetrahedra(const std::array<std::int32_t, 3>& v, std::int32_t layers) {
    const std::array<int, 3> order = order_of_rise(v);
    std::array<LocalIndex, 3> below{at(v[0], 0), at(v[1], 0), at(v[2], 0)};
    for (std::int32_t k = 1; k <= layers; ++k) {
      for (const int i : order) {
        if (count(v[i]) < k) continue;
        const LocalIndex above = at(v[i], k);
        _piece.cells.insert(_piece.cells.end(), {below[0], below[2], below[1], above});
        _of_tetrahedra.push_back(static_cast<std::int16_t>(k));
        below[i] = above;
      }
    }
  }

  /// The same over an edge from p to q.
  void add_lateral_triangles(const LateralEdge& edge, std::int32_t p, std::int32_t q) {
    const std::array<std::int32_t, 2> ends{q, p};
    const std::array<int, 2> order = order_of_rise(ends);
    std::array<LocalIndex, 2> below{at(q, 0), at(p, 0)};
    for (std::int32_t k = 1; k <= std::max(count(p), count(q)); ++k) {
      for (const int i : order) {
        if (count(ends[i]) < k) continue;
        const LocalIndex above = at(ends[i], k);
        _piece.boundary.insert(_piece.boundary.end(), {below[0], below[1], above});
        _piece.triangle_face.push_back(edge.face);
        _piece.triangle_patch.push_back(edge.patch);
        below[i] = above;
      }
    }
  }

  /// The columns over the ends of an edge, the last ones where a fan ends in the plane beside it.
  std::array<std::int32_t, 2> columns_over(const LateralEdge& edge) const {
    const std::int32_t t = edge.half_edge / 3;
    const std::array<std::int32_t, 3>& columns = _source.columns.corner_columns[t];
    std::array<std::int32_t, 2> ends{columns[edge.half_edge % 3], columns[(edge.half_edge + 1) % 3]};
    const std::vector<FanFace>& faces = _source.columns.fan_faces;
    const auto is_before = [](const FanFace& face, std::int32_t place) { return face.triangle < place; };
    for (auto face = std::lower_bound(faces.begin(), faces.end(), t, is_before);
         face != faces.end() && face->triangle == t; ++face) {
      // A fan's edges run the other way round.
      if (face->is_sector() && face->columns[0] == ends[1] && face->columns[3] == ends[0])
        ends = {face->columns[2], face->columns[1]};
    }
    return ends;
  }

  /// The lateral faces over an edge, seen from outside the cells: quadrilaterals if both columns continue,
  /// triangles if one does.
  void add_lateral(const LateralEdge& edge) {
    const auto [p, q] = columns_over(edge);
    if (_source.elements == LayerElements::tets) return add_lateral_triangles(edge, p, q);
    for (std::int32_t k = 1; k <= std::max(count(p), count(q)); ++k) {
      if (count(p) >= k && count(q) >= k) {
        _piece.quads.insert(_piece.quads.end(), {at(q, k - 1), at(p, k - 1), at(p, k), at(q, k)});
        _piece.quad_face.push_back(edge.face);
        _piece.quad_patch.push_back(edge.patch);
        continue;
      }
      const bool p_goes_on = count(p) >= k;
      _piece.boundary.insert(_piece.boundary.end(),
                             {at(q, k - 1), at(p, k - 1), p_goes_on ? at(p, k) : at(q, k)});
      _piece.triangle_face.push_back(edge.face);
      _piece.triangle_patch.push_back(edge.patch);
    }
  }

  const LayeredPiece& _source;
  const std::vector<std::uint8_t>& _shared;
  std::vector<LocalIndex> _foot;   // by vertex of the wall: in the piece; -1: not there
  std::vector<LocalIndex> _first;  // node 1 of each column, in the piece; -1: not there
  std::vector<std::int16_t> _of_tetrahedra, _of_pyramids, _of_prisms, _of_hexahedra;
  Piece _piece;
};

}  // namespace

mesh::SharedVertexKey wall_vertex_key(mesh::GlobalIndex number) {
  constexpr std::int32_t no_node = (1 << 20) - 1;
  return mesh::layer_key(number, no_node);
}

std::int32_t LayeredPiece::layers_over(LocalIndex triangle) const {
  if (!bears[triangle]) return 0;
  std::int32_t most = 0;
  for (const LocalIndex v : corners_of(wall, triangle)) most = std::max(most, columns.counts[v]);
  return most;
}

std::int32_t LayeredPiece::layers_over(const FanFace& face) const {
  return std::max(columns.counts[columns.vertex_of(face.columns[0])],
                  columns.counts[columns.vertex_of(face.columns[2])]);
}

LayersOverTriangle LayeredPiece::layers_of(const std::array<std::int32_t, 3>& corners) const {
  LayersOverTriangle counts;
  for (std::size_t i = 0; i < 3; ++i) counts[i] = columns.counts[columns.vertex_of(corners[i])];
  return counts;
}

LayersOverFan LayeredPiece::layers_of(const FanFace& face) const {
  const int other = face.is_sector() ? 2 : 0;
  return {face.is_sector(),
          {columns.counts[columns.vertex_of(face.columns[0])],
           columns.counts[columns.vertex_of(face.columns[other])]}};
}

std::int32_t LayeredPiece::cells_over(LocalIndex triangle) const {
  const std::int32_t layers = layers_over(triangle);
  if (layers == 0 || elements == LayerElements::prisms) return layers;
  std::int32_t cells = 0;
  for (const LocalIndex v : corners_of(wall, triangle)) cells += columns.counts[v];
  return cells;
}

std::vector<TriangleRange> cut_into_ranges(const LayeredPiece& source, std::int64_t most_cells) {
  std::vector<TriangleRange> ranges;
  std::int64_t cells = 0;
  LocalIndex begin = 0;
  const auto close = [&](LocalIndex end) {
    if (cells > 0) ranges.push_back({begin, end});
    begin = end, cells = 0;
  };
  for (LocalIndex t = 0; t < source.wall.cell_count(); ++t) {
    const std::int32_t more = source.cells_over(t);
    if (cells > 0 && cells + more > most_cells) close(t);
    cells += more;
  }
  close(source.wall.cell_count());
  return ranges;
}

std::vector<std::uint8_t> find_shared(const LayeredPiece& source, std::span<const TriangleRange> ranges) {
  std::vector<std::uint8_t> shared(source.wall.vertex_count(), 0);
  for (const LocalIndex v : source.wall.shared_vertices) shared[v] = 1;
  std::vector<std::int32_t> met(source.wall.vertex_count(), -1);
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    for (LocalIndex t = ranges[r].begin; t < ranges[r].end; ++t) {
      for (const LocalIndex v : corners_of(source.wall, t)) {
        const auto known = std::exchange(met[v], static_cast<std::int32_t>(r));
        if (known >= 0 && known != static_cast<std::int32_t>(r)) shared[v] = 1;
      }
    }
  }
  return shared;
}

Piece make_layer_piece(const LayeredPiece& source, TriangleRange range,
                       const std::vector<std::uint8_t>& shared) {
  return LayerPieceMaker(source, shared).make(range);
}

}  // namespace aeroloom::layers
