#include "layers/glued_cap.hpp"

#include "layers/layer_piece.hpp"
#include "layers/opened_wall.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace aeroloom::layers {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;
using mesh::SharedVertexKey;

/// Whether a triangle of the wall has no layers on either side; `front`: the position of its front side.
bool is_bare(const OpenedWall& opened, const Columns& columns, std::size_t front, LocalIndex t) {
  const auto back = static_cast<std::size_t>(opened.back_of[front]);
  const LocalIndex* const v = opened.mesh.pieces[front].cell(t);
  return std::all_of(v, v + 3, [&](LocalIndex each) {
    return columns.pieces[front].counts[each] == 0 && columns.pieces[back].counts[each] == 0;
  });
}

/// Vertices without layers get the keys of the wall.
void glue_vertices(const OpenedWall& opened, const PieceColumns& columns, std::size_t p, Piece& cap) {
  const Piece& wall = opened.mesh.pieces[p];
  std::size_t s = 0;
  for (std::size_t i = 0; i < cap.shared_vertices.size(); ++i) {
    const LocalIndex v = cap.shared_vertices[i];
    if (v >= wall.vertex_count()) break;
    while (wall.shared_vertices[s] < v) ++s;
    if (columns.counts[v] == 0) cap.shared_keys[i] = opened.base_keys[p][s];
  }
}

void glue_triangles(const OpenedWall& opened, const Columns& columns, std::size_t front, Piece& of_front,
                    Piece& of_back) {
  const Piece& wall = opened.mesh.pieces[front];
  std::size_t kept = 0;
  for (LocalIndex t = 0; t < of_back.cell_count(); ++t) {
    if (t < wall.cell_count() && is_bare(opened, columns, front, t)) {
      of_front.triangle_face[t] = opened.base_face(of_front.triangle_face[t]);
      of_front.triangle_patch[t] = opened.base_patch(of_front.triangle_patch[t]);
      continue;
    }
    std::copy_n(of_back.cell(t), 3, of_back.cells.data() + 3 * kept);
    of_back.triangle_face[kept] = of_back.triangle_face[t];
    of_back.triangle_patch[kept++] = of_back.triangle_patch[t];
  }
  of_back.cells.resize(3 * kept);
  of_back.triangle_face.resize(kept), of_back.triangle_patch.resize(kept);
}

/// A side of a vertex of the wall, on its way to the others.
struct SentFoot {
  GlobalIndex wall_number, cap_number;  ///< of the glued cap; -1: has layers there
  std::int64_t piece, vertex;
};
struct FoundFoot {
  std::int64_t piece, vertex;
  SharedVertexKey key;
};

}  // namespace

void glue_cap(const OpenedWall& opened, const Columns& columns, mesh::DistributedMesh& cap) {
  for (std::size_t p = 0; p < cap.pieces.size(); ++p)
    glue_vertices(opened, columns.pieces[p], p, cap.pieces[p]);
  for (std::size_t p = 0; p < cap.pieces.size(); ++p) {
    if (opened.back_of[p] >= 0)
      glue_triangles(opened, columns, p, cap.pieces[p],
                     cap.pieces[static_cast<std::size_t>(opened.back_of[p])]);
  }
}

LocalIndex triangle_before_gluing(const OpenedWall& opened, const Columns& columns, std::size_t p,
                                  LocalIndex triangle) {
  const Piece& wall = opened.mesh.pieces[p];
  if (!opened.is_back_piece(wall.id)) return triangle;
  const auto front = static_cast<std::size_t>(
      std::find(opened.back_of.begin(), opened.back_of.end(), static_cast<std::int64_t>(p)) -
      opened.back_of.begin());
  LocalIndex dropped = 0;
  for (LocalIndex t = 0; t < wall.cell_count() && t - dropped <= triangle; ++t)
    dropped += is_bare(opened, columns, front, t) ? 1 : 0;
  return triangle + dropped;
}

std::vector<std::vector<SharedVertexKey>> find_foot_keys(
    const OpenedWall& opened, const Columns& columns, const mesh::NumberedMesh& cap,
    const std::vector<std::optional<std::size_t>>& places) {
  std::vector<SentFoot> sent;
  std::vector<std::vector<SharedVertexKey>> keys;
  for (std::size_t p = 0; p < opened.mesh.pieces.size(); ++p) {
    const Piece& wall = opened.mesh.pieces[p];
    keys.emplace_back(wall.vertex_count(), no_foot_key);
    if (!places[p]) continue;
    for (const LocalIndex v : wall.shared_vertices) {
      const bool bare = columns.pieces[p].counts[v] == 0;
      sent.push_back(
          {opened.base_numbers[p][v], bare ? cap.numbering.vertices[*places[p]][v] : -1, wall.id, v});
    }
  }
  const mesh::Rendezvous meeting(opened.mesh.communicator, sent, &SentFoot::wall_number,
                                 [](const SentFoot& each) { return std::pair(each.piece, each.vertex); });
  const auto found = meeting.answer<FoundFoot>([](const auto& group, const auto& reply) {
    GlobalIndex bare = -1;
    for (const auto& each : group) bare = std::max(bare, each.item.cap_number);
    const SharedVertexKey key =
        bare >= 0 ? mesh::running_key(bare) : wall_vertex_key(group[0].item.wall_number);
    for (const auto& each : group) reply(each, {each.item.piece, each.item.vertex, key});
  });
  for (const FoundFoot& each : found)
    keys[mesh::position_of(opened.mesh, static_cast<mesh::PieceId>(each.piece))][each.vertex] = each.key;
  return keys;
}

void close_inner_faces(const OpenedWall& opened, mesh::DistributedMesh& volume) {
  for (Piece& piece : volume.pieces) {
    mesh::keep_boundary_triangles(piece,
                                  [&](LocalIndex t) { return !opened.is_back_face(piece.triangle_face[t]); });
    for (std::int32_t& face : piece.triangle_face) face = opened.base_face(face);
    for (std::int32_t& patch : piece.triangle_patch) patch = opened.base_patch(patch);
  }
  volume.faces = opened.before.faces;
  volume.sides = opened.before.sides;
  volume.patches = opened.before.patches;
}

}  // namespace aeroloom::layers
