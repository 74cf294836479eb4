#include "mesh/transfer/split_pieces.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace aeroloom::mesh {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Thrice the middle.
Vec3 middle_of(const Piece& piece, LocalIndex triangle) {
  const LocalIndex* v = piece.cell(triangle);
  return piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2]);
}

/// Triangles in parts of nearly equal numbers, each ascending.
class Halving {
public:
  explicit Halving(const Piece& piece) : _triangles(piece.cell_count()) {
    _middles.reserve(_triangles.size());
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) _middles.push_back(middle_of(piece, t));
    std::iota(_triangles.begin(), _triangles.end(), 0);
  }

  std::vector<std::span<const LocalIndex>> parts(int count) {
    _parts.clear();
    halve(0, _triangles.size(), count);
    return _parts;
  }

private:
  void halve(std::size_t begin, std::size_t end, int count) {
    const auto at = [&](std::size_t i) { return _triangles.begin() + static_cast<std::ptrdiff_t>(i); };
    if (count == 1) {
      std::sort(at(begin), at(end));
      _parts.push_back(std::span<const LocalIndex>(_triangles).subspan(begin, end - begin));
      return;
    }
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.add(_middles[_triangles[i]]);
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t cut = begin + (end - begin) * (count / 2) / count;
    std::nth_element(at(begin), at(cut), at(end), [&](LocalIndex a, LocalIndex b) {
      return std::pair(_middles[a][axis], a) < std::pair(_middles[b][axis], b);
    });
    halve(begin, cut, count / 2);
    halve(cut, end, count - count / 2);
  }

  std::vector<LocalIndex> _triangles;
  std::vector<Vec3> _middles;
  std::vector<std::span<const LocalIndex>> _parts;
};

/// Makes the parts of a piece.
class PartBuilder {
public:
  PartBuilder(const Piece& piece, const std::vector<std::span<const LocalIndex>>& parts)
      : _piece(piece),
        _keys(piece.vertex_count(), 0),
        _is_shared(piece.vertex_count(), 0),
        _local(piece.vertex_count(), -1) {
    std::vector<std::int32_t> last_part(piece.vertex_count(), -1);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      for (const LocalIndex t : parts[part]) {
        for (int k = 0; k < 3; ++k) {
          const LocalIndex v = piece.cell(t)[k];
          if (last_part[v] >= 0 && last_part[v] != static_cast<std::int32_t>(part)) _is_shared[v] = 1;
          last_part[v] = static_cast<std::int32_t>(part);
        }
      }
    }
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v)
      if (_is_shared[v]) _keys[v] = split_vertex_key(piece.id, v);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      _is_shared[piece.shared_vertices[s]] = 1;
      _keys[piece.shared_vertices[s]] = piece.shared_keys[s];
    }
  }

  Piece build(PieceId id, std::span<const LocalIndex> triangles) {
    Piece part;
    part.id = id;
    part.kind = _piece.kind;
    part.region = _piece.region;
    std::vector<LocalIndex> used;
    for (const LocalIndex t : triangles) {
      for (int k = 0; k < 3; ++k) used.push_back(_piece.cell(t)[k]);
      part.triangle_face.push_back(_piece.triangle_face[t]);
      part.triangle_patch.push_back(_piece.triangle_patch[t]);
    }
    geometry::sort_unique(used);
    for (std::size_t i = 0; i < used.size(); ++i) add_vertex(used[i], static_cast<LocalIndex>(i), part);
    for (const LocalIndex t : triangles)
      for (int k = 0; k < 3; ++k) part.cells.push_back(_local[_piece.cell(t)[k]]);
    return part;
  }

private:
  void add_vertex(LocalIndex v, LocalIndex number, Piece& part) {
    _local[v] = number;
    const Vec3 p = _piece.point(v);
    part.coordinates.insert(part.coordinates.end(), {p.x, p.y, p.z});
    if (!_piece.vertex_dimension.empty()) part.vertex_dimension.push_back(_piece.vertex_dimension[v]);
    if (!_piece.vertex_entity.empty()) part.vertex_entity.push_back(_piece.vertex_entity[v]);
    if (_is_shared[v] == 0) return;
    part.shared_vertices.push_back(number);
    part.shared_keys.push_back(_keys[v]);
  }

  const Piece& _piece;
  std::vector<SharedVertexKey> _keys;
  std::vector<std::uint8_t> _is_shared;
  std::vector<LocalIndex> _local;  // of the part that is being built
};

}  // namespace

NumberedMesh split_pieces(const DistributedMesh& surface, LocalIndex most,
                          const std::vector<std::int32_t>& whole,
                          const std::function<double(const Piece&)>& load_of) {
  const parallel::Communicator& communicator = surface.communicator;
  std::vector<std::int32_t> counts;
  for (const Piece& piece : surface.pieces) {
    const bool stays = std::binary_search(whole.begin(), whole.end(), piece.common_face());
    counts.push_back(stays ? 1 : std::max(1, (piece.cell_count() + most - 1) / most));
  }
  const std::vector<std::int32_t> all_counts = gather_by_piece(surface, counts);
  std::vector<PieceId> first(1, 0);
  for (const std::int32_t count : all_counts) first.push_back(first.back() + count);
  DistributedMesh result(communicator, surface);
  result.piece_count = first.back();
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    if (counts[p] == 1) {
      result.pieces.push_back(piece);
      result.pieces.back().id = first[piece.id];
      continue;
    }
    Halving halving(piece);
    const auto parts = halving.parts(counts[p]);
    PartBuilder builder(piece, parts);
    for (std::size_t i = 0; i < parts.size(); ++i)
      result.pieces.push_back(builder.build(first[piece.id] + static_cast<PieceId>(i), parts[i]));
  }
  std::vector<double> loads;
  for (const Piece& piece : result.pieces) loads.push_back(load_of ? load_of(piece) : piece.cell_count());
  loads = gather_by_piece(result, loads);
  migrate(result, parallel::assign_in_order(loads, communicator.size()));
  return number_mesh(std::move(result));
}

}  // namespace aeroloom::mesh
