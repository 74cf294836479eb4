#include "mesh/transfer/repartition.hpp"

#include "mesh/data/piece_faces.hpp"
#include "mesh/transfer/build_pieces.hpp"
#include "mesh/transfer/hilbert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace aeroloom::mesh {

namespace {

/// Places along the curve, over the box of the whole mesh.
class Curve {
public:
  Curve(const DistributedMesh& mesh) {
    const parallel::Communicator& communicator = mesh.communicator;
    constexpr double huge = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{huge, huge, huge}, high{-huge, -huge, -huge};
    for (const Piece& piece : mesh.pieces) {
      for (std::size_t i = 0; i < piece.coordinates.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], piece.coordinates[i]);
        high[i % 3] = std::max(high[i % 3], piece.coordinates[i]);
      }
    }
    double widest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      _low[k] = communicator.minimum(low[k]);
      widest = std::max(widest, communicator.maximum(high[k]) - _low[k]);
    }
    _cells_per_length = widest > 0 ? ((1U << hilbert_bits) - 1) / widest : 0;
  }

  std::uint64_t key(const Piece& piece, CellOfPiece cell) const {
    std::array<double, 3> middle{};
    const LocalIndex* v = vertices_of(piece, cell);
    const int corners = corners_of(cell.shape);
    for (int k = 0; k < corners; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle[axis] += piece.coordinates[3 * static_cast<std::size_t>(v[k]) + axis];
    }
    std::array<std::uint32_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = place((middle[axis] / corners - _low[axis]) * _cells_per_length);
    return hilbert_key(at);
  }

private:
  /// Rounding may lead a little, sums of huge coordinates far, beyond the box.
  static std::uint32_t place(double along) {
    constexpr double last = (1U << hilbert_bits) - 1;
    return along > 0 ? static_cast<std::uint32_t>(std::min(along, last)) : 0;
  }

  std::array<double, 3> _low{};
  double _cells_per_length = 0;
};

/// Where to cut a spread set of keys: `shares` parts as equal as keys allow.
class Cuts {
public:
  Cuts(const parallel::Communicator& communicator, std::vector<std::uint64_t> keys, std::int32_t shares) {
    std::sort(keys.begin(), keys.end());
    const GlobalIndex total = communicator.sum(static_cast<std::int64_t>(keys.size()));
    // The highest key with no more than so many keys below it, bit by bit for all cuts at a time.
    const auto cuts = static_cast<std::size_t>(shares - 1);
    std::vector<GlobalIndex> wanted(cuts), below(cuts);
    for (std::size_t i = 0; i < cuts; ++i) {
      const auto k = static_cast<GlobalIndex>(i) + 1;
      wanted[i] = total / shares * k + total % shares * k / shares;
    }
    _first.assign(cuts, 0);
    for (int bit = 3 * hilbert_bits - 1; bit >= 0; --bit) {
      for (std::size_t i = 0; i < cuts; ++i) {
        const std::uint64_t tried = _first[i] | std::uint64_t{1} << bit;
        below[i] = std::lower_bound(keys.begin(), keys.end(), tried) - keys.begin();
      }
      const auto all = communicator.all_gather_items(std::span<const GlobalIndex>(below));
      std::fill(below.begin(), below.end(), 0);
      for (std::size_t i = 0; i < all.size(); ++i) below[i % cuts] += all[i];
      for (std::size_t i = 0; i < cuts; ++i) {
        if (below[i] <= wanted[i]) _first[i] |= std::uint64_t{1} << bit;
      }
    }
  }

  std::int32_t share(std::uint64_t key) const {
    return static_cast<std::int32_t>(std::upper_bound(_first.begin(), _first.end(), key) - _first.begin());
  }

private:
  std::vector<std::uint64_t> _first;  // key of each share but the first
};

/// Cells by region, of all ranks. Collective.
std::vector<GlobalIndex> cells_by_region(const DistributedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  std::vector<GlobalIndex> cells(static_cast<std::size_t>(mesh.region_count()), 0);
  for (const Piece& piece : mesh.pieces) {
    for (const CellShape shape : cell_shapes) {
      for_each_region_run(piece, shape, [&](RegionId region, LocalIndex begin, LocalIndex end) {
        cells.at(static_cast<std::size_t>(region)) += end - begin;
      });
    }
  }
  for (GlobalIndex& count : cells) count = communicator.sum(count);
  return cells;
}

/// The pieces that each region gets; one share for all where pieces may hold several.
struct RegionShare {
  PieceId first = 0, count = 1;
};

std::vector<RegionShare> share_out(const DistributedMesh& mesh, PieceId pieces, PieceRegions regions) {
  if (regions == PieceRegions::several) return {{0, pieces}};
  const std::vector<GlobalIndex> cells = cells_by_region(mesh);
  const GlobalIndex all =
      std::max<GlobalIndex>(1, std::accumulate(cells.begin(), cells.end(), GlobalIndex{0}));
  std::vector<RegionShare> shares;
  PieceId next = 0;
  for (const GlobalIndex count : cells) {
    const auto fair =
        static_cast<PieceId>(std::lround(static_cast<double>(count) / static_cast<double>(all) * pieces));
    shares.push_back({next, count == 0 ? 0 : std::max(1, fair)});
    next += shares.back().count;
  }
  return shares;
}

/// The new piece of each cell on this rank, by local piece and cell.
class Cutter {
public:
  Cutter(const DistributedMesh& mesh, PieceId pieces, PieceRegions regions)
      : _mesh(mesh), _shares(share_out(mesh, pieces, regions)), _pieces_of(mesh.pieces.size()) {
    const Curve curve(mesh);
    std::vector<std::vector<std::uint64_t>> keys(_shares.size());
    std::vector<std::vector<std::uint64_t>> of_piece(mesh.pieces.size());
    for_each_cell([&](std::size_t p, CellOfPiece cell, std::size_t group) {
      of_piece[p].push_back(curve.key(_mesh.pieces[p], cell));
      keys[group].push_back(of_piece[p].back());
    });
    std::vector<Cuts> cuts;
    for (std::size_t g = 0; g < _shares.size(); ++g)
      cuts.emplace_back(mesh.communicator, std::move(keys[g]), std::max(1, _shares[g].count));
    for_each_cell([&](std::size_t p, CellOfPiece, std::size_t group) {
      const std::uint64_t key = of_piece[p][_pieces_of[p].size()];
      _pieces_of[p].push_back(_shares[group].first + cuts[group].share(key));
    });
  }

  PieceId piece_count() const { return std::max(1, _shares.back().first + _shares.back().count); }
  /// By cell.
  const std::vector<PieceId>& pieces_of(std::size_t local_piece) const { return _pieces_of[local_piece]; }

private:
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (std::size_t p = 0; p < _mesh.pieces.size(); ++p) {
      for (const CellShape shape : cell_shapes) {
        for_each_region_run(_mesh.pieces[p], shape, [&](RegionId region, LocalIndex begin, LocalIndex end) {
          const std::size_t group = _shares.size() == 1 ? 0 : static_cast<std::size_t>(region);
          for (LocalIndex i = begin; i < end; ++i) visit(p, CellOfPiece{shape, i}, group);
        });
      }
    }
  }

  const DistributedMesh& _mesh;
  std::vector<RegionShare> _shares;
  std::vector<std::vector<PieceId>> _pieces_of;
};

/// New pieces of the boundary faces of a piece: those of the cells that they are seen from outside of.
std::vector<PieceId> pieces_of_faces(const Piece& piece, const std::vector<PieceId>& pieces_of_cells) {
  std::vector<PieceId> result(boundary_face_count(piece), 0);
  const PieceFaces faces(piece);
  match_faces(
      static_cast<std::size_t>(piece.vertex_count()), faces,
      [&](const FaceKey<LocalIndex>&, std::span<const FaceUser> users) {
        for (const FaceUser& user : users) {
          if (user.is_cell()) continue;
          for (const FaceUser& other : users) {
            if (other.is_cell() && same_direction(faces.face(user.item), faces.side(other.item, other.side)))
              result[user.item] = pieces_of_cells[other.item];
          }
        }
      });
  return result;
}

/// The items of one piece. Their order is that of the pieces, and in a piece their own.
class ItemsOfPiece {
public:
  ItemsOfPiece(const Piece& piece, const std::vector<GlobalIndex>& numbers, PieceItems& items)
      : _piece(piece), _numbers(numbers), _items(items) {}

  void add_cells(const std::vector<PieceId>& pieces_of_cells) {
    const PieceId* to = pieces_of_cells.data();
    for_each_cell_shape([&](auto s) {
      constexpr auto n = static_cast<std::size_t>(corners_of(cell_shapes[s]));
      auto& out = std::get<s>(_items.cells);
      const LocalIndex* corners = connectivity_of(_piece, cell_shapes[s]).data();
      for_each_region_run(_piece, cell_shapes[s], [&](RegionId region, LocalIndex begin, LocalIndex end) {
        for (LocalIndex i = begin; i < end; ++i, corners += n)
          out.push_back({by_number<n>(corners), order(i), *to++, region});
      });
    });
  }

  void add_faces(const std::vector<PieceId>& pieces) {
    const PieceId* to = pieces.data();
    for_each_face_shape([&](auto s) {
      auto& out = std::get<s>(_items.faces);
      const LocalIndex* corners = connectivity_of(_piece, face_shapes[s]).data();
      const auto faces = cad_faces_of(_piece, face_shapes[s]), patches = patches_of(_piece, face_shapes[s]);
      for (std::size_t i = 0; i < faces.size(); ++i, corners += s + 3)
        out.push_back(
            {by_number<s + 3>(corners), order(static_cast<LocalIndex>(i)), *to++, patches[i], faces[i]});
    });
  }

private:
  template <std::size_t N>
  std::array<GlobalIndex, N> by_number(const LocalIndex* corners) const {
    std::array<GlobalIndex, N> result;
    for (std::size_t k = 0; k < N; ++k) result[k] = _numbers[corners[k]];
    return result;
  }
  GlobalIndex order(LocalIndex i) const { return GlobalIndex{_piece.id} << 32 | i; }

  const Piece& _piece;
  const std::vector<GlobalIndex>& _numbers;
  PieceItems& _items;
};

/// Calls visit(number, piece, vertex) for the vertices that pieces of this rank own.
template <class Visit>
void for_each_owned(const NumberedMesh& mesh, const Visit& visit) {
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      if (mesh.numbering.owned[p][v]) visit(mesh.numbering.vertices[p][v], mesh.pieces[p], v);
    }
  }
}

DistributedMesh names_of(const DistributedMesh& mesh) {
  DistributedMesh names(mesh.communicator);
  names.patches = mesh.patches;
  names.patch_types = mesh.patch_types;
  names.faces = mesh.faces;
  names.sides = mesh.sides;
  names.regions = mesh.regions;
  return names;
}

}  // namespace

NumberedMesh repartition(const NumberedMesh& mesh, PieceId pieces, PieceRegions regions) {
  const parallel::Communicator& communicator = mesh.communicator;
  DistributedMesh names = names_of(mesh);
  PieceItems items;
  {
    const Cutter cutter(mesh, std::max(1, pieces), regions);
    names.piece_count = cutter.piece_count();
    for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
      ItemsOfPiece of_piece(mesh.pieces[p], mesh.numbering.vertices[p], items);
      of_piece.add_cells(cutter.pieces_of(p));
      of_piece.add_faces(pieces_of_faces(mesh.pieces[p], cutter.pieces_of(p)));
    }
  }
  const KeyRanges ranges = even_ranges(communicator.size(), mesh.numbering.vertex_count);
  std::vector<PointTable::KeyedValue> points;
  std::vector<VertexClassTable::KeyedValue> classes;
  bool is_classified = true;
  for_each_owned(mesh, [&](GlobalIndex number, const Piece& piece, LocalIndex v) {
    const geometry::Vec3 p = piece.point(v);
    points.push_back({number, {p.x, p.y, p.z}});
    if (piece.vertex_dimension.empty()) {
      is_classified = false;
    } else {
      classes.push_back(
          {number, {static_cast<std::int32_t>(piece.vertex_dimension[v]), piece.vertex_entity[v]}});
    }
  });
  const PointTable point_table(communicator, ranges, std::move(points));
  const bool all_classified = communicator.minimum(std::int64_t{is_classified}) == 1;
  if (!all_classified) classes.clear();
  const VertexClassTable class_table(communicator, ranges, std::move(classes));
  return build_pieces(std::move(items), {point_table, all_classified ? &class_table : nullptr},
                      Ownership::by_piece, std::move(names));
}

}  // namespace aeroloom::mesh
