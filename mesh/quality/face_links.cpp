#include "mesh/quality/face_links.hpp"

#include "mesh/exchange/rendezvous.hpp"

#include <tuple>
#include <utility>

namespace aeroloom::mesh {

namespace {

/// A side of a cell that found no other cell in its piece.
struct LoneSide {
  FaceKey<GlobalIndex> key;
  CellNeighbour cell;
  std::int32_t bounded;  ///< 1: there is a boundary face

  auto place() const { return std::tuple(cell.piece, cell.cell, cell.side); }
};

/// Tells a side its neighbour.
struct Introduction {
  CellNeighbour cell, neighbour;
};

/// Matches what is inside one piece.
class PieceLinker {
public:
  PieceLinker(const Piece& piece, const std::vector<GlobalIndex>& numbers, std::vector<LoneSide>& lone,
              LinkDefects& defects)
      : _piece(piece), _numbers(numbers), _lone(lone), _defects(defects) {}

  PieceLinks link() {
    const std::size_t sides = first_side(_piece, _piece.total_cell_count());
    _links.neighbours.resize(sides);
    _links.boundary_face.assign(sides, -1);
    match_faces(
        static_cast<std::size_t>(_piece.vertex_count()), PieceFaces(_piece),
        [&](const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) { link_face(key, users); });
    return std::move(_links);
  }

private:
  void link_face(const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) {
    LocalIndex face = -1;
    std::array<FaceUser, 2> cells;
    std::size_t count = 0;
    for (const FaceUser& user : users) {
      if (!user.is_cell()) {
        if (face >= 0) ++_defects.repeated_faces;
        face = user.item;
      } else {
        if (count < 2) cells[count] = user;
        ++count;
      }
    }
    if (count == 0) ++_defects.stray_faces;
    if (count > 2) ++_defects.crowded_faces;
    if (count == 0 || count > 2) return;
    for (std::size_t i = 0; i < count; ++i) _links.boundary_face[side_of(cells[i])] = face;
    if (count == 2) {
      _links.neighbours[side_of(cells[0])] = {_piece.id, cells[1].item, cells[1].side};
      _links.neighbours[side_of(cells[1])] = {_piece.id, cells[0].item, cells[0].side};
      return;
    }
    FaceKey<GlobalIndex> numbers{-1, -1, -1, -1};
    for (std::size_t k = 0; k < 4; ++k) {
      if (key[k] >= 0) numbers[k] = _numbers[key[k]];
    }
    _lone.push_back({face_key(numbers), {_piece.id, cells[0].item, cells[0].side}, face >= 0 ? 1 : 0});
  }

  std::size_t side_of(const FaceUser& user) const {
    return first_side(_piece, user.item) + static_cast<std::size_t>(user.side);
  }

  const Piece& _piece;
  const std::vector<GlobalIndex>& _numbers;
  std::vector<LoneSide>& _lone;
  LinkDefects& _defects;
  PieceLinks _links;
};

std::vector<Introduction> introduce(const parallel::Communicator& communicator,
                                    const std::vector<LoneSide>& lone, LinkDefects& defects) {
  const Rendezvous meeting(communicator, lone, &LoneSide::key, &LoneSide::place);
  return meeting.answer<Introduction>([&](const auto& group, const auto& reply) {
    if (group.size() > 2) ++defects.crowded_faces;
    if (group.size() == 1 && group[0].item.bounded == 0) ++defects.open_faces;
    if (group.size() != 2) return;
    reply(group[0], {group[0].item.cell, group[1].item.cell});
    reply(group[1], {group[1].item.cell, group[0].item.cell});
  });
}

}  // namespace

FaceLinks link_faces(const NumberedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  FaceLinks links;
  std::vector<LoneSide> lone;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    links.pieces.push_back(
        PieceLinker(mesh.pieces[i], mesh.numbering.vertices[i], lone, links.defects).link());
  for (const auto& [cell, neighbour] : introduce(communicator, lone, links.defects)) {
    const std::size_t at = position_of(mesh, cell.piece);
    links.pieces[at]
        .neighbours[first_side(mesh.pieces[at], cell.cell) + static_cast<std::size_t>(cell.side)] = neighbour;
  }
  LinkDefects& defects = links.defects;
  for (GlobalIndex* count :
       {&defects.crowded_faces, &defects.stray_faces, &defects.repeated_faces, &defects.open_faces})
    *count = communicator.sum(*count);
  return links;
}

}  // namespace aeroloom::mesh
