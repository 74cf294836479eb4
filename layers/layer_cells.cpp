#include "aeroloom/layers/layer_cells.hpp"

#include "aeroloom/parallel/communication/collective_error.hpp"
#include "layers/layer_piece.hpp"
#include "mesh/distributed_table.hpp"
#include "mesh/shared_vertex_keys.hpp"
#include "mesh/shared_vertices.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::layers {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;
using parallel::Communicator;

namespace {

/// What pieces of the volume ask of a vertex of the wall.
struct WallVertex {
  std::int32_t count;              ///< of layers over it
  std::int32_t dimension, entity;  ///< its classification; as wide as each other, so that there is no padding

  static constexpr auto fields() {
    return std::tuple(&WallVertex::count, &WallVertex::dimension, &WallVertex::entity);
  }
};
using WallTable = mesh::DistributedTable<WallVertex>;

WallTable make_table(const Communicator& communicator, const mesh::NumberedMesh& wall,
                     const Columns& columns) {
  std::vector<WallTable::KeyedValue> rows;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    const Piece& piece = wall.mesh.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (!wall.numbering.owned[p][v]) continue;
      rows.push_back({wall.numbering.vertices[p][v],
                      {columns.pieces[p].counts[v], static_cast<std::int32_t>(piece.vertex_dimension[v]),
                       piece.vertex_entity[v]}});
    }
  }
  return {communicator, mesh::even_ranges(communicator.size(), wall.numbering.vertex_count), std::move(rows)};
}

/// The pieces behind the front: their vertices on it get keys that layers know, and their classification; the
/// triangles that layers lie before are boundary no more.
class BehindFront {
public:
  BehindFront(const Communicator& communicator, const mesh::NumberedMesh& wall, const Columns& columns,
              mesh::DistributedMesh& volume)
      : _wall(wall.mesh) {
    const WallTable table = make_table(communicator, wall, columns);
    for (const Piece& piece : volume.pieces) {
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        if (is_on_boundary(piece.vertex_dimension[v])) _asked.push_back(piece.vertex_entity[v]);
      }
    }
    std::sort(_asked.begin(), _asked.end());
    _asked.erase(std::unique(_asked.begin(), _asked.end()), _asked.end());
    const WallTable::Fetched found = table.fetch(_asked);
    if (found.missing >= 0)
      throw parallel::CollectiveError(
          parallel::FailureKind::bug,
          fmt::format("layers: the volume has a vertex of the front, {}, that the wall lacks",
                      found.missing));
    _rows = found.values;
    for (Piece& piece : volume.pieces) join(piece);
  }

private:
  const WallVertex& row(GlobalIndex number) const {
    return _rows[std::lower_bound(_asked.begin(), _asked.end(), number) - _asked.begin()];
  }

  void join(Piece& piece) const {
    std::vector<std::uint8_t> grows(piece.vertex_count(), 0);
    std::vector<std::pair<LocalIndex, mesh::SharedVertexKey>> keys;
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      if (!is_on_boundary(piece.vertex_dimension[piece.shared_vertices[s]]))
        keys.emplace_back(piece.shared_vertices[s], piece.shared_keys[s]);
    }
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (!is_on_boundary(piece.vertex_dimension[v])) continue;
      const GlobalIndex number = piece.vertex_entity[v];
      const WallVertex& of_wall = row(number);
      keys.emplace_back(v, mesh::running_key(number));
      grows[v] = of_wall.count > 0 ? 1 : 0;
      piece.vertex_dimension[v] =
          grows[v] ? mesh::CadDimension::region : static_cast<mesh::CadDimension>(of_wall.dimension);
      piece.vertex_entity[v] = grows[v] ? piece.region : of_wall.entity;
    }
    std::sort(keys.begin(), keys.end());
    piece.shared_vertices.clear(), piece.shared_keys.clear();
    for (const auto& [vertex, key] : keys) {
      piece.shared_vertices.push_back(vertex);
      piece.shared_keys.push_back(key);
    }
    keep_bare_triangles(piece, grows);
  }

  void keep_bare_triangles(Piece& piece, const std::vector<std::uint8_t>& grows) const {
    std::size_t kept = 0;
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      const bool covered = bears_layers(_wall, piece.triangle_patch[t]) &&
                           std::any_of(v, v + 3, [&](LocalIndex each) { return grows[each] != 0; });
      if (covered) continue;
      std::copy_n(v, 3, piece.boundary.begin() + 3 * static_cast<std::ptrdiff_t>(kept));
      piece.triangle_face[kept] = piece.triangle_face[t];
      piece.triangle_patch[kept] = piece.triangle_patch[t];
      ++kept;
    }
    piece.boundary.resize(3 * kept);
    piece.triangle_face.resize(kept);
    piece.triangle_patch.resize(kept);
  }

  const mesh::DistributedMesh& _wall;
  std::vector<GlobalIndex> _asked;  // ascending
  std::vector<WallVertex> _rows;    // of those
};

std::vector<std::uint8_t> bearing_triangles(const mesh::DistributedMesh& wall, const Piece& piece) {
  std::vector<std::uint8_t> bears;
  bears.reserve(piece.triangle_patch.size());
  for (const std::int32_t patch : piece.triangle_patch) bears.push_back(bears_layers(wall, patch) ? 1 : 0);
  return bears;
}

/// The pieces of the layers over the pieces of the wall on this rank, by piece of the wall, without ids.
std::vector<std::vector<Piece>> make_pieces(const mesh::NumberedMesh& wall, const Layers& layers,
                                            const std::vector<LateralEdge>& laterals,
                                            std::int64_t most_cells) {
  std::vector<std::vector<Piece>> made(wall.mesh.pieces.size());
  for (std::size_t p = 0; p < made.size(); ++p) {
    const Piece& piece = wall.mesh.pieces[p];
    const auto [first, last] =
        std::equal_range(laterals.begin(), laterals.end(), LateralEdge{piece.id, 0, 0, 0},
                         [](const LateralEdge& a, const LateralEdge& b) { return a.piece < b.piece; });
    const std::vector<std::uint8_t> bears = bearing_triangles(wall.mesh, piece);
    const LayeredPiece source{piece,
                              layers.front.pieces[p],
                              layers.columns.pieces[p],
                              wall.numbering.vertices[p],
                              bears,
                              {first, last},
                              wall.mesh.sides_of(piece.common_face()).front};
    const std::vector<TriangleRange> ranges = cut_into_ranges(source, most_cells);
    const std::vector<std::uint8_t> shared = find_shared(source, ranges);
    for (const TriangleRange range : ranges) made[p].push_back(make_layer_piece(source, range, shared));
  }
  return made;
}

}  // namespace

void name_front(const Communicator& communicator, const mesh::NumberedMesh& wall,
                mesh::DistributedMesh& front) {
  parallel::agree(communicator, [&] {
    if (wall.numbering.vertex_count > std::numeric_limits<std::int32_t>::max())
      throw std::runtime_error("layers: the surface has more vertices than 2^31");
    for (std::size_t p = 0; p < front.pieces.size(); ++p) {
      Piece& piece = front.pieces[p];
      piece.vertex_dimension = wall.mesh.pieces[p].vertex_dimension;
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v)
        piece.vertex_entity[v] = static_cast<std::int32_t>(wall.numbering.vertices[p][v]);
    }
  });
}

void append_layers(const Communicator& communicator, const mesh::NumberedMesh& wall, const Layers& layers,
                   std::int64_t most_cells_per_piece, mesh::DistributedMesh& volume) {
  BehindFront(communicator, wall, layers.columns, volume);
  const std::vector<LateralEdge> laterals = find_lateral_edges(communicator, wall, layers.columns);
  std::vector<std::vector<Piece>> made;
  parallel::agree(communicator, [&] { made = make_pieces(wall, layers, laterals, most_cells_per_piece); });
  std::vector<GlobalIndex> counts;
  for (const std::vector<Piece>& pieces : made) counts.push_back(static_cast<GlobalIndex>(pieces.size()));
  const std::vector<GlobalIndex> first = mesh::first_by_piece(communicator, wall.mesh, counts);
  for (std::size_t p = 0; p < made.size(); ++p) {
    auto id = static_cast<PieceId>(volume.piece_count + first[p]);
    for (Piece& piece : made[p]) {
      piece.id = id++;
      volume.pieces.push_back(std::move(piece));
    }
  }
  volume.piece_count += static_cast<PieceId>(first.back());
  mesh::SharedVertices(communicator, volume).drop_unshared(volume);
}

}  // namespace aeroloom::layers
