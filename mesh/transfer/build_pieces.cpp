#include "mesh/transfer/build_pieces.hpp"

#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/delivery.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/transfer/id_table.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace aeroloom::mesh {

namespace {

/// Which rank gets piece p of `pieces`: they ascend with ranks.
parallel::Rank rank_of_piece(PieceId piece, PieceId pieces, int ranks) {
  return static_cast<parallel::Rank>(static_cast<std::int64_t>(piece) * ranks / pieces);
}

template <class Item>
void send_items(const parallel::Communicator& communicator, PieceId pieces, std::vector<Item>& items) {
  items = deliver(communicator, std::move(items),
                  [&](const Item& item) { return rank_of_piece(item.piece, pieces, communicator.size()); });
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::tie(a.piece, a.group, a.order, a.corners) < std::tie(b.piece, b.group, b.order, b.corners);
  });
}

/// The items of one piece among those that are sorted by piece.
template <class Item>
std::span<const Item> items_of(const std::vector<Item>& items, PieceId piece) {
  const auto less = [](const Item& item, PieceId id) { return item.piece < id; };
  const auto begin = std::lower_bound(items.begin(), items.end(), piece, less);
  const auto end = std::lower_bound(begin, items.end(), piece + 1, less);
  return {items.data() + (begin - items.begin()), static_cast<std::size_t>(end - begin)};
}

/// The vertices that piece k of `pieces` owns by their numbers alone.
struct NumberShare {
  GlobalIndex begin, end;

  NumberShare(GlobalIndex count, PieceId piece, PieceId pieces)
      : begin(first_of(count, piece, pieces)), end(first_of(count, piece + 1, pieces)) {}
  bool has(GlobalIndex number) const { return number >= begin && number < end; }

private:
  static GlobalIndex first_of(GlobalIndex count, PieceId piece, PieceId pieces) {
    return count / pieces * piece + count % pieces * piece / pieces;
  }
};

/// The numbers of the vertices that a piece knows, ascending.
std::vector<GlobalIndex> known_to(PieceId piece, const PieceItems& items) {
  std::vector<GlobalIndex> known;
  const auto collect = [&](const auto& all) {
    for (const auto& item : items_of(all, piece))
      known.insert(known.end(), item.corners.begin(), item.corners.end());
  };
  for_each_cell_shape([&](auto s) { collect(std::get<s>(items.cells)); });
  for_each_face_shape([&](auto s) { collect(std::get<s>(items.faces)); });
  return IdTable(std::move(known)).numbers();
}

/// Puts one piece together; its vertices are `known`.
Piece build_piece(PieceId id, const PieceItems& items, const std::vector<GlobalIndex>& known) {
  const IdTable table(known);
  Piece piece;
  piece.id = id;
  const auto add_corners = [&](const auto& item, std::vector<LocalIndex>& corners) {
    for (const GlobalIndex number : item.corners) corners.push_back(table.place(number));
  };
  std::vector<LocalIndex>* const cells[cell_shape_count] = {&piece.cells, &piece.pyramids, &piece.prisms,
                                                            &piece.hexahedra};
  LocalIndex cell = 0;
  for_each_cell_shape([&](auto s) {
    for (const auto& item : items_of(std::get<s>(items.cells), id)) {
      add_corners(item, *cells[s]);
      if (piece.runs.empty() || piece.runs.back().region != item.group) piece.runs.push_back({item.group, 0});
      piece.runs.back().end = ++cell;
    }
  });
  if (!piece.runs.empty()) piece.region = piece.runs.front().region;
  if (piece.runs.size() == 1) piece.runs.clear();
  const auto add_faces = [&](const auto& all, std::vector<LocalIndex>& corners,
                             std::vector<std::int32_t>& faces, std::vector<std::int32_t>& patches) {
    for (const auto& item : items_of(all, id)) {
      add_corners(item, corners);
      faces.push_back(item.face);
      patches.push_back(item.group);
    }
  };
  add_faces(std::get<0>(items.faces), piece.boundary, piece.triangle_face, piece.triangle_patch);
  add_faces(std::get<1>(items.faces), piece.quads, piece.quad_face, piece.quad_patch);
  piece.shared_vertices.resize(known.size());
  std::iota(piece.shared_vertices.begin(), piece.shared_vertices.end(), 0);
  for (const GlobalIndex number : known) piece.shared_keys.push_back(running_key(number));
  return piece;
}

/// Gives the pieces of this rank what the tables say of their vertices. Collective.
void fetch_vertices(const VertexTables& tables, const std::vector<std::vector<GlobalIndex>>& known,
                    std::vector<Piece>& pieces) {
  std::vector<GlobalIndex> keys;
  for (const auto& numbers : known) keys.insert(keys.end(), numbers.begin(), numbers.end());
  keys = IdTable(std::move(keys)).numbers();
  const auto for_each_vertex = [&](const auto& visit) {
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      for (const GlobalIndex number : known[p])
        visit(pieces[p],
              static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), number) - keys.begin()));
    }
  };
  {
    const PointTable::Fetched found = tables.points.fetch(keys);
    for_each_vertex([&](Piece& piece, std::size_t at) {
      piece.coordinates.insert(piece.coordinates.end(), found.values[at].begin(), found.values[at].end());
    });
  }
  if (tables.classes == nullptr) return;
  const VertexClassTable::Fetched found = tables.classes->fetch(keys);
  for_each_vertex([&](Piece& piece, std::size_t at) {
    piece.vertex_dimension.push_back(static_cast<CadDimension>(found.values[at].dimension));
    piece.vertex_entity.push_back(found.values[at].entity);
  });
}

/// Vertices in the order of their numbers.
void order_vertices(Piece& piece, std::vector<GlobalIndex>& numbers, std::vector<std::uint8_t>& owned) {
  std::vector<LocalIndex> order(numbers.size()), place(numbers.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](LocalIndex a, LocalIndex b) { return numbers[a] < numbers[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<LocalIndex>(i);
  const auto permute = [&](auto& values) {
    if (values.empty()) return;
    auto old = values;
    for (std::size_t i = 0; i < order.size(); ++i) values[i] = old[order[i]];
  };
  permute(numbers);
  permute(owned);
  permute(piece.vertex_dimension);
  permute(piece.vertex_entity);
  const std::vector<double> old = std::move(piece.coordinates);
  piece.coordinates.clear();
  piece.coordinates.reserve(old.size());
  for (const LocalIndex v : order)
    piece.coordinates.insert(piece.coordinates.end(), old.begin() + 3 * std::ptrdiff_t{v},
                             old.begin() + 3 * std::ptrdiff_t{v} + 3);
  for (auto* corners :
       {&piece.cells, &piece.pyramids, &piece.prisms, &piece.hexahedra, &piece.boundary, &piece.quads}) {
    for (LocalIndex& v : *corners) v = place[v];
  }
  std::vector<std::pair<LocalIndex, SharedVertexKey>> shared;
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
    shared.emplace_back(place[piece.shared_vertices[s]], piece.shared_keys[s]);
  std::sort(shared.begin(), shared.end());
  for (std::size_t s = 0; s < shared.size(); ++s)
    std::tie(piece.shared_vertices[s], piece.shared_keys[s]) = shared[s];
}

}  // namespace

NumberedMesh build_pieces(PieceItems items, const VertexTables& vertices, Ownership ownership,
                          DistributedMesh names) {
  const parallel::Communicator communicator = names.communicator;
  NumberedMesh mesh{std::move(names), {}};
  Numbering& numbering = mesh.numbering;
  for_each_cell_shape([&](auto s) { send_items(communicator, mesh.piece_count, std::get<s>(items.cells)); });
  for_each_face_shape([&](auto s) { send_items(communicator, mesh.piece_count, std::get<s>(items.faces)); });
  const GlobalIndex count = vertices.points.count();
  std::vector<std::vector<GlobalIndex>> known;
  for (PieceId id = 0; id < mesh.piece_count; ++id) {
    if (rank_of_piece(id, mesh.piece_count, communicator.size()) != communicator.rank()) continue;
    known.push_back(known_to(id, items));
    if (ownership == Ownership::by_number) {
      const NumberShare share(count, id, mesh.piece_count);
      const std::size_t needed = known.back().size();
      known.back().resize(needed + static_cast<std::size_t>(share.end - share.begin));
      std::iota(known.back().begin() + static_cast<std::ptrdiff_t>(needed), known.back().end(), share.begin);
      known.back() = IdTable(std::move(known.back())).numbers();
    }
    mesh.pieces.push_back(build_piece(id, items, known.back()));
  }
  items = {};
  fetch_vertices(vertices, known, mesh.pieces);
  SharedVertices shared(mesh);
  if (ownership == Ownership::by_piece) {
    numbering = find_numbers(mesh, shared);
    shared.drop_unshared(mesh);
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
      order_vertices(mesh.pieces[i], numbering.vertices[i], numbering.owned[i]);
    return mesh;
  }
  shared.drop_unshared(mesh);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const NumberShare share(count, mesh.pieces[i].id, mesh.piece_count);
    std::vector<std::uint8_t>& owned = numbering.owned.emplace_back();
    for (const GlobalIndex number : known[i]) owned.push_back(share.has(number) ? 1 : 0);
  }
  numbering.vertices = std::move(known);
  numbering.vertex_count = count;
  number_cells(mesh, numbering);
  return mesh;
}

}  // namespace aeroloom::mesh
