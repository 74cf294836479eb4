#include "surface/joined_pieces.hpp"

#include "mesh/exchange/delivery.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace aeroloom::surface {
namespace {

using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;

/// Of the pieces of a face that are joined, together: no more than a few pieces have by default. Chosen, not
/// measured.
constexpr std::int64_t most_triangles = 40'000;

struct PieceRow {
  std::int64_t triangles;
  std::int32_t face, rank;
  std::int64_t has_moved;
};

/// What becomes of the pieces, by their present number.
struct Joining {
  std::vector<PieceId> number;  ///< afterwards
  std::vector<parallel::Rank> owner;
  std::vector<PieceId> moved;  ///< by new number, ascending
};

Joining plan(const FollowingFaces& faces, const std::vector<PieceRow>& rows) {
  std::map<std::int32_t, std::int64_t> triangles;  // of moved pieces, by face
  for (const PieceRow& row : rows) {
    if (row.has_moved != 0 && faces.follows(row.face)) triangles[row.face] += row.triangles;
  }
  Joining joining;
  joining.number.resize(rows.size());
  for (const PieceRow& row : rows) joining.owner.push_back(row.rank);
  PieceId next = 0;
  for (std::size_t p = 0; p < rows.size(); ++p) {
    if (!faces.follows(rows[p].face)) joining.number[p] = next++;
  }
  std::map<std::int32_t, std::size_t> first;  // moved piece, by face
  for (std::size_t p = 0; p < rows.size(); ++p) {
    if (!faces.follows(rows[p].face)) continue;
    if (rows[p].has_moved != 0 && triangles[rows[p].face] <= most_triangles) {
      const auto [known, is_first] = first.emplace(rows[p].face, p);
      if (!is_first) {
        joining.number[p] = joining.number[known->second];
        joining.owner[p] = joining.owner[known->second];
        continue;
      }
    }
    joining.number[p] = next++;
    if (rows[p].has_moved != 0) joining.moved.push_back(joining.number[p]);
  }
  return joining;
}

/// Appends a piece to another of the same face; vertices with the same key become one.
void join(const Piece& more, Piece& piece) {
  std::map<mesh::SharedVertexKey, LocalIndex> known;
  for (std::size_t s = 0; s < piece.shared_keys.size(); ++s)
    known.emplace(piece.shared_keys[s], piece.shared_vertices[s]);
  std::vector<LocalIndex> number(more.vertex_count(), -1);
  std::map<LocalIndex, mesh::SharedVertexKey> keys;
  for (std::size_t s = 0; s < more.shared_keys.size(); ++s) {
    const auto found = known.find(more.shared_keys[s]);
    if (found != known.end()) {
      number[more.shared_vertices[s]] = found->second;
    } else {
      keys.emplace(more.shared_vertices[s], more.shared_keys[s]);
    }
  }
  for (LocalIndex v = 0; v < more.vertex_count(); ++v) {
    if (number[v] >= 0) continue;
    number[v] = piece.vertex_count();
    const geometry::Vec3 p = more.point(v);
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    piece.vertex_dimension.push_back(more.vertex_dimension[v]);
    piece.vertex_entity.push_back(more.vertex_entity[v]);
    if (const auto key = keys.find(v); key != keys.end()) {
      piece.shared_vertices.push_back(number[v]);
      piece.shared_keys.push_back(key->second);
    }
  }
  for (const LocalIndex v : more.cells) piece.cells.push_back(number[v]);
  piece.triangle_face.insert(piece.triangle_face.end(), more.triangle_face.begin(), more.triangle_face.end());
  piece.triangle_patch.insert(piece.triangle_patch.end(), more.triangle_patch.begin(),
                              more.triangle_patch.end());
}

}  // namespace

std::vector<PieceId> join_moved_pieces(const FollowingFaces& faces,
                                       const std::vector<std::uint8_t>& has_moved,
                                       mesh::DistributedMesh& surface) {
  std::vector<PieceRow> mine;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    mine.push_back({piece.cell_count(), piece.common_face(), surface.communicator.rank(), has_moved[p]});
  }
  Joining joining = plan(faces, mesh::gather_by_piece(surface, mine));
  mesh::migrate(surface, joining.owner);
  std::map<PieceId, Piece> pieces;
  for (Piece& piece : surface.pieces) {
    const PieceId id = joining.number[piece.id];
    const auto [known, is_first] = pieces.emplace(id, Piece());
    if (is_first) {
      known->second = std::move(piece);
      known->second.id = id;
    } else {
      join(piece, known->second);
    }
  }
  surface.pieces.clear();
  for (auto& [id, piece] : pieces) surface.pieces.push_back(std::move(piece));
  surface.piece_count =
      joining.number.empty() ? 0 : *std::max_element(joining.number.begin(), joining.number.end()) + 1;
  return joining.moved;
}

}  // namespace aeroloom::surface
