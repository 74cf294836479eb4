#include "layers/layer_piece.hpp"

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
      : _source(source), _shared(shared), _first(source.wall.vertex_count(), -1) {
    _piece.region = source.region;
  }

  Piece make(TriangleRange range) {
    auto lateral = std::lower_bound(
        _source.laterals.begin(), _source.laterals.end(), 3 * range.begin,
        [](const LateralEdge& edge, std::int32_t half_edge) { return edge.half_edge < half_edge; });
    for (LocalIndex t = range.begin; t < range.end; ++t) {
      const std::int32_t layers = _source.layers_over(t);
      if (layers > 0) add_triangle(t, layers);
      for (; lateral != _source.laterals.end() && lateral->half_edge < 3 * (t + 1); ++lateral)
        add_lateral(*lateral);
    }
    _piece.layers = std::move(_of_tetrahedra);
    _piece.layers.insert(_piece.layers.end(), _of_pyramids.begin(), _of_pyramids.end());
    _piece.layers.insert(_piece.layers.end(), _of_prisms.begin(), _of_prisms.end());
    return std::move(_piece);
  }

private:
  std::int32_t count(LocalIndex v) const { return _source.columns.counts[v]; }
  /// Node k of a column, or its last.
  LocalIndex at(LocalIndex v, std::int32_t k) const { return _first[v] + std::min(k, count(v)); }

  void add_triangle(LocalIndex t, std::int32_t layers) {
    const Triangle v = corners_of(_source.wall, t);
    for (const LocalIndex each : v) {
      if (_first[each] < 0) add_column(each);
    }
    for (const LocalIndex each : v) _piece.boundary.push_back(at(each, 0));
    _piece.triangle_face.push_back(_source.wall.triangle_face[t]);
    _piece.triangle_patch.push_back(_source.wall.triangle_patch[t]);
    if (_source.elements == LayerElements::tets) return add_tetrahedra(v, layers);
    for (std::int32_t k = 1; k <= layers; ++k) add_cell(v, k);
  }

  void add_column(LocalIndex v) {
    _first[v] = _piece.vertex_count();
    for (std::int32_t k = 0; k <= count(v); ++k) add_node(v, k);
  }

  void add_node(LocalIndex v, std::int32_t k) {
    const bool on_wall = k == 0, on_cap = k == count(v);
    const LocalIndex here = _piece.vertex_count();
    const Vec3 p = on_wall  ? _source.wall.point(v)
                   : on_cap ? _source.cap.point(v)
                            : node(_source.wall, _source.columns, v, k);
    _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
    _piece.vertex_dimension.push_back(on_wall ? _source.wall.vertex_dimension[v]
                                              : mesh::CadDimension::region);
    _piece.vertex_entity.push_back(on_wall ? _source.wall.vertex_entity[v] : _source.region);
    if (!on_cap && !_shared[v]) return;
    _piece.shared_vertices.push_back(here);
    _piece.shared_keys.push_back(on_cap ? mesh::running_key(_source.numbers[v])
                                        : mesh::layer_key(_source.numbers[v], k));
  }

  /// Wall triangles are counter-clockwise seen from outside. Cells start with the triangle as seen from
  /// inside.
  void add_cell(const Triangle& v, std::int32_t k) {
    const auto live = std::count_if(v.begin(), v.end(), [&](LocalIndex each) { return count(each) >= k; });
    const auto layer = static_cast<std::int16_t>(k);
    if (live == 3) {
      _piece.prisms.insert(_piece.prisms.end(), {at(v[0], k - 1), at(v[2], k - 1), at(v[1], k - 1),
                                                 at(v[0], k), at(v[2], k), at(v[1], k)});
      _of_prisms.push_back(layer);
      return;
    }
    // Rotated until the columns that continue come first.
    Triangle w = v;
    while (count(w[0]) < k || (live == 2 && count(w[1]) < k)) std::rotate(w.begin(), w.begin() + 1, w.end());
    const LocalIndex last = at(w[2], k);
    if (live == 2) {
      _piece.pyramids.insert(_piece.pyramids.end(),
                             {at(w[1], k - 1), at(w[1], k), at(w[0], k), at(w[0], k - 1), last});
      _of_pyramids.push_back(layer);
    } else {
      _piece.cells.insert(_piece.cells.end(), {at(w[0], k - 1), last, at(w[1], k), at(w[0], k)});
      _of_tetrahedra.push_back(layer);
    }
  }

  /// Corners by the numbers of their columns, the largest first: in this order columns rise.
  template <std::size_t Count>
  std::array<int, Count> order_of_rise(const std::array<LocalIndex, Count>& v) const {
    std::array<int, Count> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return _source.numbers[v[a]] > _source.numbers[v[b]]; });
    return order;
  }

  void add_tetrahedra(const Triangle& v, std::int32_t layers) {
    const std::array<int, 3> order = order_of_rise(v);
    Triangle below{at(v[0], 0), at(v[1], 0), at(v[2], 0)};
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
  void add_lateral_triangles(const LateralEdge& edge, LocalIndex p, LocalIndex q) {
    const std::array<LocalIndex, 2> ends{q, p};
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

  /// The lateral faces over an edge, seen from outside the cells: quadrilaterals if both columns continue,
  /// triangles if one does.
  void add_lateral(const LateralEdge& edge) {
    const Triangle v = corners_of(_source.wall, edge.half_edge / 3);
    const LocalIndex p = v[edge.half_edge % 3], q = v[(edge.half_edge + 1) % 3];
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
  std::vector<LocalIndex> _first;  // node 0 of each column, in the piece; -1: not there
  std::vector<std::int16_t> _of_tetrahedra, _of_pyramids, _of_prisms;
  Piece _piece;
};

}  // namespace

std::int32_t LayeredPiece::layers_over(LocalIndex triangle) const {
  if (!bears[triangle]) return 0;
  std::int32_t most = 0;
  for (const LocalIndex v : corners_of(wall, triangle)) most = std::max(most, columns.counts[v]);
  return most;
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
