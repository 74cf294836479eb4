#include "layers/layer_cells.hpp"

#include "geometry/sort_unique.hpp"
#include "layers/cap_layout.hpp"
#include "layers/glued_cap.hpp"
#include "layers/layer_piece.hpp"
#include "layers/opened_wall.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/distributed_table.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::layers {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;

namespace {

/// The place in the cap of each local piece of the wall; nothing for planes that were meshed again. All
/// others come first, in order.
std::vector<std::optional<std::size_t>> places_in_cap(const mesh::DistributedMesh& wall,
                                                      const mesh::DistributedMesh& cap,
                                                      const OpenedWall* opened) {
  std::vector<std::optional<std::size_t>> places(wall.pieces.size());
  std::size_t next = 0;
  for (std::size_t p = 0; p < places.size() && next < cap.pieces.size(); ++p) {
    const std::vector<std::int32_t>&of_wall = wall.pieces[p].triangle_face,
          &of_cap = cap.pieces[next].triangle_face;
    const auto is_same = [&](std::int32_t a, std::int32_t b) {
      return a == b || (opened != nullptr && opened->base_face(a) == opened->base_face(b));
    };
    const bool is_back = opened != nullptr && opened->is_back_piece(wall.pieces[p].id);
    if (is_back || (of_wall.size() <= of_cap.size() &&
                    std::equal(of_wall.begin(), of_wall.end(), of_cap.begin(), is_same)))
      places[p] = next++;
  }
  return places;
}

/// By vertex of the cap over a piece; 1 under apexes.
std::vector<std::int32_t> counts_under(const CapLayout& layout, const PieceColumns& columns) {
  std::vector<std::int32_t> counts;
  for (const std::int32_t column : layout.column_of_vertex)
    counts.push_back(column < 0 ? 1 : columns.counts[columns.vertex_of(column)]);
  return counts;
}

/// The number of layers under each cap vertex.
using CountTable = mesh::DistributedTable<std::int32_t>;

CountTable make_table(const mesh::DistributedMesh& wall, const Columns& columns,
                      const mesh::NumberedMesh& cap, const std::vector<std::optional<std::size_t>>& places) {
  std::vector<std::vector<std::int32_t>> counts(cap.pieces.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (places[p])
      counts[*places[p]] = counts_under(lay_out_cap(wall.pieces[p], columns.pieces[p]), columns.pieces[p]);
  }
  std::vector<CountTable::KeyedValue> rows;
  for (std::size_t p = 0; p < cap.pieces.size(); ++p) {
    const Piece& piece = cap.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (!cap.numbering.owned[p][v]) continue;
      rows.push_back({cap.numbering.vertices[p][v], counts[p].empty() ? 0 : counts[p][v]});
    }
  }
  return {cap.communicator, mesh::even_ranges(cap.communicator.size(), cap.numbering.vertex_count),
          std::move(rows)};
}

/// Connects the pieces outside the cap to the layers. Cap vertices get the keys used by layers. Those off the
/// wall are now inside the region. Triangles under layers are removed from the boundary.
class BeyondCap {
public:
  /// Collective.
  BeyondCap(const mesh::DistributedMesh& wall, const CountTable& table, const mesh::DistributedMesh& volume)
      : _wall(wall) {
    for (const Piece& piece : volume.pieces) {
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        if (is_on_boundary(piece.vertex_dimension[v])) _asked.push_back(number_of(piece, v));
      }
    }
    geometry::sort_unique(_asked);
    const CountTable::Fetched found = table.fetch(_asked);
    if (found.missing >= 0)
      throw parallel::CollectiveError(
          parallel::FailureKind::bug,
          fmt::format("layers: the volume has vertex {} of the layer cap, which does not exist",
                      found.missing));
    _counts = found.values;
  }

  void join(mesh::DistributedMesh& volume) const {
    for (Piece& piece : volume.pieces) join(piece);
  }

private:
  static GlobalIndex number_of(const Piece& piece, LocalIndex v) {
    return piece.surface_numbers.empty() ? -1 : piece.surface_numbers[v];
  }
  std::int32_t count(GlobalIndex number) const {
    return _counts[std::lower_bound(_asked.begin(), _asked.end(), number) - _asked.begin()];
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
      const GlobalIndex number = number_of(piece, v);
      keys.emplace_back(v, mesh::running_key(number));
      if (count(number) == 0) continue;
      grows[v] = 1;
      piece.vertex_dimension[v] = mesh::CadDimension::region;
      piece.vertex_entity[v] = piece.region;
    }
    piece.surface_numbers = {};
    std::sort(keys.begin(), keys.end());
    piece.shared_vertices.clear(), piece.shared_keys.clear();
    for (const auto& [vertex, key] : keys) {
      piece.shared_vertices.push_back(vertex);
      piece.shared_keys.push_back(key);
    }
    mesh::keep_boundary_triangles(piece, [&](LocalIndex t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      return !bears_layers(_wall, piece.triangle_patch[t]) ||
             std::none_of(v, v + 3, [&](LocalIndex each) { return grows[each] != 0; });
    });
  }

  const mesh::DistributedMesh& _wall;
  std::vector<GlobalIndex> _asked;    // ascending
  std::vector<std::int32_t> _counts;  // of those
};

std::vector<std::uint8_t> bearing_triangles(const mesh::DistributedMesh& wall, const Piece& piece) {
  std::vector<std::uint8_t> bears;
  bears.reserve(piece.triangle_patch.size());
  for (const std::int32_t patch : piece.triangle_patch) bears.push_back(bears_layers(wall, patch) ? 1 : 0);
  return bears;
}

/// What cells are made from besides the columns.
struct CellSources {
  std::vector<std::optional<std::size_t>> places;  ///< by piece of the wall: in the cap
  std::vector<LateralEdge> laterals;
  std::vector<std::vector<mesh::SharedVertexKey>> foot_keys;  ///< of an opened wall
};

/// The pieces of the layers over the pieces of the wall on this rank, by piece of the wall, without ids.
std::vector<std::vector<Piece>> make_pieces(const mesh::NumberedMesh& wall, const Columns& columns,
                                            const mesh::NumberedMesh& cap, const CellSources& sources,
                                            const LayerCellOptions& options) {
  const auto& [places, laterals, foot_keys] = sources;
  std::vector<std::vector<Piece>> made(wall.pieces.size());
  for (std::size_t p = 0; p < made.size(); ++p) {
    if (!places[p]) continue;
    const Piece& piece = wall.pieces[p];
    const auto [first, last] =
        std::equal_range(laterals.begin(), laterals.end(), LateralEdge{piece.id, 0, 0, 0},
                         [](const LateralEdge& a, const LateralEdge& b) { return a.piece < b.piece; });
    const std::vector<std::uint8_t> bears = bearing_triangles(wall, piece);
    const CapLayout layout = lay_out_cap(piece, columns.pieces[p]);
    LayeredPiece source{piece,
                        cap.pieces[*places[p]],
                        columns.pieces[p],
                        layout,
                        wall.numbering.vertices[p],
                        cap.numbering.vertices[*places[p]],
                        bears,
                        {first, last},
                        {},
                        wall.sides_of(piece.common_face()).front,
                        options.elements};
    if (!foot_keys.empty()) source.foot_keys = foot_keys[p];
    const std::vector<TriangleRange> ranges = cut_into_ranges(source, options.most_cells_per_piece);
    const std::vector<std::uint8_t> shared = find_shared(source, ranges);
    for (const TriangleRange range : ranges) made[p].push_back(make_layer_piece(source, range, shared));
  }
  return made;
}

/// Classifies vertices off the wall that lie on a boundary face on its plane; of two planes the lower number
/// counts. All pieces agree. Collective.
void classify_on_planes(mesh::SharedVertices& shared, mesh::DistributedMesh& volume) {
  struct Place {
    std::int32_t dimension, entity;
    bool operator<(const Place& other) const {
      return std::tie(dimension, entity) < std::tie(other.dimension, other.entity);
    }
  };
  constexpr auto on_face = static_cast<std::int32_t>(mesh::CadDimension::face);
  std::vector<std::vector<Place>> places;
  for (const Piece& piece : volume.pieces) {
    std::vector<Place>& of_piece = places.emplace_back();
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v)
      of_piece.push_back({static_cast<std::int32_t>(piece.vertex_dimension[v]), piece.vertex_entity[v]});
    for (LocalIndex f = 0; f < mesh::boundary_face_count(piece); ++f) {
      for (const LocalIndex v : mesh::corners_of_boundary(piece, f))
        of_piece[v] = std::min(of_piece[v], Place{on_face, mesh::cad_face_of(piece, f)});
    }
  }
  shared.combine(places, [](const Place& a, const Place& b) { return std::min(a, b); });
  for (std::size_t p = 0; p < places.size(); ++p) {
    Piece& piece = volume.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      piece.vertex_dimension[v] = static_cast<mesh::CadDimension>(places[p][v].dimension);
      piece.vertex_entity[v] = places[p][v].entity;
    }
  }
}

}  // namespace

void append_layers(const mesh::NumberedMesh& wall, const Columns& columns, const mesh::NumberedMesh& cap,
                   const LayerCellOptions& options, mesh::DistributedMesh& volume) {
  CellSources sources{places_in_cap(wall, cap, options.opened), find_lateral_edges(wall, columns), {}};
  BeyondCap(wall, make_table(wall, columns, cap, sources.places), volume).join(volume);
  if (options.opened != nullptr)
    sources.foot_keys = find_foot_keys(*options.opened, columns, cap, sources.places);
  std::vector<std::vector<Piece>> made;
  parallel::agree(wall.communicator, [&] { made = make_pieces(wall, columns, cap, sources, options); });
  std::vector<GlobalIndex> counts;
  counts.reserve(made.size());
  for (const std::vector<Piece>& pieces : made) counts.push_back(static_cast<GlobalIndex>(pieces.size()));
  const std::vector<GlobalIndex> first = mesh::first_by_piece(wall, counts);
  for (std::size_t p = 0; p < made.size(); ++p) {
    auto id = static_cast<PieceId>(volume.piece_count + first[p]);
    for (Piece& piece : made[p]) {
      piece.id = id++;
      volume.pieces.push_back(std::move(piece));
    }
  }
  volume.piece_count += static_cast<PieceId>(first.back());
  if (options.opened != nullptr) close_inner_faces(*options.opened, volume);
  mesh::SharedVertices shared(volume);
  shared.drop_unshared(volume);
  if (wall.communicator.sum(static_cast<std::int64_t>(sources.laterals.size())) > 0)
    classify_on_planes(shared, volume);
}

}  // namespace aeroloom::layers
