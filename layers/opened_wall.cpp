#include "layers/opened_wall.hpp"

#include "layers/vertex_sides.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/delivery.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace aeroloom::layers {
namespace {

using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;
using mesh::SharedVertexKey;

/// A triangle at a vertex that several pieces may know, on its way to the others there.
struct SentSide {
  SharedVertexKey key;
  geometry::Vec3 vertex;
  SidedTriangle triangle;
  std::int64_t local;  ///< number of the vertex in the piece
};

/// The sides of one vertex of a piece: the part of space before its front, and that behind its back.
struct FoundSides {
  std::int64_t piece, local;
  std::array<std::int32_t, 2> sides;
};

/// Triangles of a piece by vertex.
class PieceTriangles {
public:
  PieceTriangles(const Piece& piece, mesh::FaceSides sides)
      : _piece(piece),
        _sides(sides),
        _names(mesh::name_vertices(piece)),
        _first(piece.vertex_count() + 2, 0) {
    for (const LocalIndex v : piece.cells) ++_first[v + 2];
    for (std::size_t v = 2; v < _first.size(); ++v) _first[v] += _first[v - 1];
    _around.resize(piece.cells.size());
    for (std::size_t i = 0; i < piece.cells.size(); ++i)
      _around[_first[piece.cells[i] + 1]++] = static_cast<LocalIndex>(i);
  }

  /// Calls visit(triangle) for those around a vertex.
  template <class Visit>
  void for_each_around(LocalIndex v, const Visit& visit) const {
    for (std::int64_t i = _first[v]; i < _first[v + 1]; ++i) {
      const LocalIndex t = _around[i] / 3;
      const int at = _around[i] % 3;
      const LocalIndex next = _piece.cell(t)[(at + 1) % 3], previous = _piece.cell(t)[(at + 2) % 3];
      visit(SidedTriangle{_names[next], _names[previous], _piece.point(next), _piece.point(previous),
                          _sides.front, _sides.back, _piece.id, t});
    }
  }

private:
  const Piece& _piece;
  mesh::FaceSides _sides;
  std::vector<mesh::VertexName> _names;
  std::vector<std::int64_t> _first;
  std::vector<LocalIndex> _around;
};

/// The sides of a vertex in each piece of its star, which is in the order of pieces, from 1 on: once some
/// have layers and others none, the former are no vertices of the wall any more. All are 0 where there is
/// one, where a piece is at several, or where there are more than can be named.
std::vector<FoundSides> sides_by_piece(geometry::Vec3 vertex, std::span<const SidedTriangle> star,
                                       bool can_name) {
  const VertexSides of_triangles = find_vertex_sides(vertex, star);
  std::vector<FoundSides> found;
  bool sound = can_name;
  std::int32_t last = 0;
  for (std::size_t t = 0; t < star.size(); ++t) {
    last = std::max({last, of_triangles[t][0], of_triangles[t][1]});
    if (!found.empty() && found.back().piece == star[t].piece) {
      sound = sound && found.back().sides == of_triangles[t];
    } else {
      found.push_back({star[t].piece, 0, of_triangles[t]});
    }
  }
  sound = sound && last > 0 && last < mesh::last_vertex_side;
  for (FoundSides& each : found) {
    for (std::int32_t& side : each.sides) side = sound ? side + 1 : 0;
  }
  return found;
}

bool has_inner(std::span<const SidedTriangle> star) {
  return std::any_of(star.begin(), star.end(), [](const SidedTriangle& t) { return t.is_inner(); });
}

class WallOpener {
public:
  explicit WallOpener(const mesh::NumberedMesh& wall) : _wall(wall) {}

  OpenedWall open() {
    find_sides();
    _opened.before = _wall;
    mesh::DistributedMesh& mesh = _opened.mesh;
    mesh = mesh::DistributedMesh(_wall.communicator, facts());
    _opened.back_of.assign(_wall.pieces.size(), -1);
    const std::vector<PieceId> ids = ids_of_backs();
    for (std::size_t p = 0; p < _wall.pieces.size(); ++p) add(p, 0, _wall.pieces[p].id);
    for (std::size_t p = 0; p < _wall.pieces.size(); ++p) {
      if (!is_inner(p)) continue;
      _opened.back_of[p] = static_cast<std::int64_t>(mesh.pieces.size());
      add(p, 1, ids[p]);
      _opened.back_of.push_back(-1);
    }
    _opened.mesh = mesh::number_mesh(std::move(mesh));
    return std::move(_opened);
  }

private:
  mesh::FaceSides sides_of(std::size_t p) const { return _wall.sides_of(_wall.pieces[p].common_face()); }
  bool is_inner(std::size_t p) const { return sides_of(p).is_inner(); }

  mesh::MeshFacts facts() const {
    mesh::MeshFacts facts = _wall;
    facts.sides.resize(facts.faces.size());
    for (std::size_t f = 0; f < _wall.faces.size(); ++f) {
      const mesh::FaceSides sides = _wall.sides_of(static_cast<std::int32_t>(f));
      facts.sides[f] = sides;
      facts.faces.push_back(_wall.faces[f] + " (front)");
      facts.sides.push_back({sides.front, mesh::no_region});
      facts.faces.push_back(_wall.faces[f] + " (back)");
      facts.sides.push_back({sides.is_inner() ? sides.back : sides.front, mesh::no_region});
    }
    facts.patch_types.resize(facts.patches.size(), mesh::PatchType::wall);
    for (const std::string& patch : _wall.patches) {
      facts.patches.push_back(patch + " (front)");
      facts.patches.push_back(patch + " (back)");
      facts.patch_types.insert(facts.patch_types.end(), 2, mesh::PatchType::wall);
    }
    return facts;
  }

  /// By piece on this rank; sets their number in all.
  std::vector<PieceId> ids_of_backs() {
    std::vector<mesh::GlobalIndex> counts;
    for (std::size_t p = 0; p < _wall.pieces.size(); ++p) counts.push_back(is_inner(p) ? 1 : 0);
    const std::vector<mesh::GlobalIndex> first = mesh::first_by_piece(_wall, counts);
    std::vector<PieceId> ids;
    for (std::size_t p = 0; p < _wall.pieces.size(); ++p)
      ids.push_back(_wall.piece_count + static_cast<PieceId>(first[p]));
    _opened.mesh.piece_count = _wall.piece_count + static_cast<PieceId>(first.back());
    return ids;
  }

  void find_sides() {
    std::vector<SentSide> sent;
    std::vector<SidedTriangle> star;
    for (std::size_t p = 0; p < _wall.pieces.size(); ++p) {
      const Piece& piece = _wall.pieces[p];
      const PieceTriangles triangles(piece, sides_of(p));
      std::vector<std::uint8_t> shared(piece.vertex_count(), 0);
      for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
        const LocalIndex v = piece.shared_vertices[s];
        shared[v] = 1;
        triangles.for_each_around(v, [&](const SidedTriangle& t) {
          sent.push_back({piece.shared_keys[s], piece.point(v), t, v});
        });
      }
      _sides.emplace_back(piece.vertex_count(), std::array<std::int32_t, 2>{0, 0});
      if (!is_inner(p)) continue;
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        star.clear();
        if (shared[v] == 0) triangles.for_each_around(v, [&](const SidedTriangle& t) { star.push_back(t); });
        if (!star.empty())
          _sides[p][v] =
              sides_by_piece(piece.point(v), star, mesh::can_name_sides(mesh::split_vertex_key(piece.id, v)))
                  .front()
                  .sides;
      }
    }
    for (const FoundSides& found : meet(sent)) {
      const std::size_t p = mesh::position_of(_wall, static_cast<PieceId>(found.piece));
      _sides[p][found.local] = found.sides;
    }
  }

  std::vector<FoundSides> meet(const std::vector<SentSide>& sent) const {
    const mesh::Rendezvous meeting(_wall.communicator, sent, &SentSide::key, [](const SentSide& each) {
      return std::pair(each.triangle.piece, each.triangle.cell);
    });
    return meeting.answer<FoundSides>([](const auto& group, const auto& reply) {
      std::vector<SidedTriangle> star;
      for (const auto& received : group) star.push_back(received.item.triangle);
      if (!has_inner(star)) return;
      const SentSide& first = group[0].item;
      std::vector<FoundSides> found = sides_by_piece(first.vertex, star, mesh::can_name_sides(first.key));
      for (std::size_t i = 0, next = 0; next < found.size(); ++i) {
        if (group[i].item.triangle.piece != found[next].piece) continue;
        found[next].local = group[i].item.local;
        reply(group[i], found[next++]);
      }
    });
  }

  /// One side of a piece: a new piece.
  void add(std::size_t p, int side, PieceId id) {
    const Piece& piece = _wall.pieces[p];
    const bool inner = is_inner(p);
    Piece made = piece;
    made.id = id;
    std::vector<SharedVertexKey>& base = _opened.base_keys.emplace_back(piece.shared_keys);
    if (inner) {
      base.clear(), made.shared_vertices.clear();
      std::size_t s = 0;
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        made.shared_vertices.push_back(v);
        const bool shared = s < piece.shared_vertices.size() && piece.shared_vertices[s] == v;
        base.push_back(shared ? piece.shared_keys[s++] : mesh::inside_vertex_key(piece.id, v));
      }
      for (std::int32_t& face : made.triangle_face)
        face = _opened.front_of(face, _opened.face_count()) + side;
      const int of_patch = sides_of(p).front == sides_of(p).back ? 1 - side : side;  // see InnerSides
      for (std::int32_t& patch : made.triangle_patch)
        patch = _opened.front_of(patch, _opened.patch_count()) + of_patch;
    }
    if (side == 1) {
      for (std::size_t t = 0; t < made.cells.size(); t += 3) std::swap(made.cells[t + 1], made.cells[t + 2]);
    }
    made.shared_keys = base;
    for (std::size_t s = 0; s < base.size(); ++s) {
      const std::int32_t of_space = _sides[p][made.shared_vertices[s]][static_cast<std::size_t>(side)];
      if (of_space > 0) made.shared_keys[s] = mesh::side_vertex_key(base[s], of_space);
    }
    _opened.base_numbers.push_back(_wall.numbering.vertices[p]);
    _opened.mesh.pieces.push_back(std::move(made));
  }

  const mesh::NumberedMesh& _wall;
  OpenedWall _opened;
  std::vector<std::vector<std::array<std::int32_t, 2>>> _sides;  // by piece and vertex
};

}  // namespace

OpenedWall open_inner_faces(const mesh::NumberedMesh& wall) {
  return WallOpener(wall).open();
}

}  // namespace aeroloom::layers
