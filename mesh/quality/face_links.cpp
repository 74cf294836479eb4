#include "mesh/quality/face_links.hpp"

#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
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

/// The faces of one piece by their corners, each with what has it: some chains for each lowest vertex.
class FaceTable {
public:
  static constexpr LocalIndex none = -1, crowded = -2;
  struct Entry {
    std::array<LocalIndex, 3> rest;  ///< the corners but the lowest
    LocalIndex next;                 ///< in the chain, or none
    LocalIndex lowest;
    LocalIndex first = none, second = none;  ///< sides of cells; `second` is crowded where there are more
    LocalIndex boundary_face = none;
  };

  void clear(std::size_t vertices) {
    _chains.assign(vertices << bits, none);
    _entries.clear();
  }
  /// The face with these corners, ascending; a triangle's `d` is -1. A new one where there is none yet;
  /// valid until the next call.
  Entry& at(LocalIndex a, LocalIndex b, LocalIndex c, LocalIndex d) {
    LocalIndex& chain = _chains[chain_of(a, b, c)];
    for (LocalIndex i = chain; i != none;) {
      Entry& entry = _entries[static_cast<std::size_t>(i)];
      if (entry.rest[0] == b && entry.rest[1] == c && entry.rest[2] == d) return entry;
      i = entry.next;
    }
    _entries.push_back({{b, c, d}, chain, a});
    chain = static_cast<LocalIndex>(_entries.size()) - 1;
    return _entries.back();
  }
  const std::vector<Entry>& entries() const { return _entries; }

private:
  static constexpr int bits = 3;
  static std::size_t chain_of(LocalIndex a, LocalIndex b, LocalIndex c) {
    const std::uint32_t mixed =
        static_cast<std::uint32_t>(b) * 0x9E3779B1u + static_cast<std::uint32_t>(c) * 0x85EBCA77u;
    return static_cast<std::size_t>(a) << bits | mixed >> (32 - bits);
  }

  std::vector<LocalIndex> _chains;  // the newest entry of each, or none
  std::vector<Entry> _entries;
};

/// Matches what is inside one piece.
class PieceLinker {
public:
  PieceLinker(const Piece& piece, FaceTable& table) : _piece(piece), _table(table) {
    _table.clear(static_cast<std::size_t>(piece.vertex_count()));
    add_boundary();
    add_cells<faces_of_tetrahedra, 4>(piece.cells, 0);
    add_cells<faces_of_pyramids, 5>(piece.pyramids, piece.cell_count());
    add_cells<faces_of_prisms, 6>(piece.prisms, first_cell(piece, CellShape::prism));
    add_cells<faces_of_hexahedra, 8>(piece.hexahedra, first_cell(piece, CellShape::hexahedron));
  }

  /// `numbers`: of the vertices. Adds to the sides without a neighbour, and to the defects.
  PieceLinks link(const std::vector<GlobalIndex>& numbers, std::vector<LoneSide>& lone,
                  LinkDefects& defects) const {
    PieceLinks links;
    const std::size_t sides = first_side(_piece, _piece.total_cell_count());
    links.neighbours.resize(sides);
    links.boundary_face.assign(sides, -1);
    defects.repeated_faces += _repeated_faces;
    for (const FaceTable::Entry& face : _table.entries()) {
      if (face.first == FaceTable::none) ++defects.stray_faces;
      if (face.second == FaceTable::crowded) ++defects.crowded_faces;
      if (face.first == FaceTable::none || face.second == FaceTable::crowded) continue;
      const auto first = static_cast<std::size_t>(face.first), second = static_cast<std::size_t>(face.second);
      links.boundary_face[first] = face.boundary_face;
      if (face.second == FaceTable::none) {
        lone.push_back({key_of(face, numbers), cell_at(first), face.boundary_face >= 0 ? 1 : 0});
        continue;
      }
      links.boundary_face[second] = face.boundary_face;
      links.neighbours[first] = cell_at(second);
      links.neighbours[second] = cell_at(first);
    }
    return links;
  }

private:
  void add_boundary() {
    PieceFaces(_piece).for_each_face([&](const FaceKey<LocalIndex>& corners, LocalIndex number) {
      const FaceKey<LocalIndex> key = face_key(corners);
      FaceTable::Entry& face = _table.at(key[0], key[1], key[2], key[3]);
      if (face.boundary_face >= 0) ++_repeated_faces;
      face.boundary_face = number;
    });
  }

  /// The sides of all cells of one shape, the first of which is cell `first`.
  template <const auto& faces, std::size_t corners>
  void add_cells(const std::vector<LocalIndex>& vertices, LocalIndex first) {
    auto next = static_cast<LocalIndex>(first_side(_piece, first));
    const LocalIndex* const end = vertices.data() + vertices.size();
    for (const LocalIndex* cell = vertices.data(); cell != end; cell += corners) {
      [&]<std::size_t... side>(std::index_sequence<side...>) {
        (add_side(face_at<faces[side]>(cell), next++), ...);
      }
      (std::make_index_sequence<faces.size()>{});
    }
  }

  template <CellFace face>
  FaceTable::Entry& face_at(const LocalIndex* cell) {
    LocalIndex a = cell[face[0]], b = cell[face[1]], c = cell[face[2]];
    sort(a, b), sort(b, c), sort(a, b);
    if constexpr (face[3] < 0) {
      return _table.at(a, b, c, -1);
    } else {
      LocalIndex d = cell[face[3]];
      sort(c, d), sort(b, c), sort(a, b);
      return _table.at(a, b, c, d);
    }
  }
  /// Without a branch.
  static void sort(LocalIndex& a, LocalIndex& b) {
    const LocalIndex lower = std::min(a, b);
    b = std::max(a, b);
    a = lower;
  }

  static void add_side(FaceTable::Entry& face, LocalIndex side) {
    if (face.first == FaceTable::none) {
      face.first = side;
    } else {
      face.second = face.second == FaceTable::none ? side : FaceTable::crowded;
    }
  }

  CellNeighbour cell_at(std::size_t side) const {
    const SideOfCell place = cell_at_side(_piece, side);
    return {_piece.id, place.cell, place.side};
  }
  static FaceKey<GlobalIndex> key_of(const FaceTable::Entry& face, const std::vector<GlobalIndex>& numbers) {
    FaceKey<GlobalIndex> corners{numbers[static_cast<std::size_t>(face.lowest)], -1, -1, -1};
    for (std::size_t k = 0; k < 3; ++k) {
      if (face.rest[k] >= 0) corners[k + 1] = numbers[static_cast<std::size_t>(face.rest[k])];
    }
    return face_key(corners);
  }

  const Piece& _piece;
  FaceTable& _table;
  GlobalIndex _repeated_faces = 0;
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
  FaceTable table;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    links.pieces.push_back(
        PieceLinker(mesh.pieces[i], table).link(mesh.numbering.vertices[i], lone, links.defects));
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
