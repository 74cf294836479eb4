/// Shared vertices: who owns what several pieces know, and sums over all who know it. Elsewhere an index map
/// and its scatterer (FEniCS/dolfinx, common/IndexMap.h and common/Scatterer.h).
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/neighbour_exchange.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::mesh {

/// Vertices of a piece with keys: equal keys are one vertex. Both lists are of one length.
struct KeyedVertices {
  PieceId piece = 0;
  std::span<const LocalIndex> vertices;
  std::span<const std::uint64_t> keys;
};

/// What the pieces of this rank know of vertices that others may know too. Each vertex of a piece's list is a
/// *copy*; copies are numbered piece by piece, in the order of the list. The lowest piece that knows a vertex
/// owns it. Values of copies are arrays in this order.
///
/// Who knows what is found once. It holds until pieces change, or lists, or ranks; coordinates may.
class SharedVertices {
public:
  /// From the shared-vertex keys of the mesh, whose arrays fit together. Collective.
  explicit SharedVertices(const DistributedMesh& mesh);
  /// From other keys; pieces in any order, each on one rank. Collective. Both throw CollectiveError when a
  /// piece has a key twice.
  SharedVertices(const parallel::Communicator& communicator, std::span<const KeyedVertices> pieces);

  std::size_t size() const { return _vertices.size(); }  ///< copies on this rank
  /// The first copy of the p-th piece on this rank; size() for p = number of pieces.
  std::size_t first(std::size_t p) const { return _first[p]; }
  LocalIndex vertex(std::size_t copy) const { return _vertices[copy]; }
  bool is_owned(std::size_t copy) const { return _kinds[copy] != Kind::of_another; }  ///< by its own piece
  bool is_shared(std::size_t copy) const { return _kinds[copy] != Kind::alone; }  ///< another piece knows it

  /// Calls visit(p, vertex, copy) for all copies of each piece p on this rank.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t p = 0, copy = 0; p + 1 < _first.size(); ++p) {
      for (; copy < _first[p + 1]; ++copy) visit(p, _vertices[copy], copy);
    }
  }

  /// Replaces the value of each owner's copy by that of all pieces: ((v0 op v1) op v2) ..., `op(total,
  /// value)` in the order of piece ids, whatever the ranks. Other copies stay. Collective.
  template <parallel::Flat T, class Op>
  void reduce(std::vector<T>& copies, const Op& op) const;
  /// Replaces the values of all copies by those of their owners. Collective.
  template <parallel::Flat T>
  void scatter(std::vector<T>& copies) const;
  /// Reduces over all copies, and gives each the result. Collective.
  template <parallel::Flat T, class Op>
  void reduce_and_scatter(std::vector<T>& copies, const Op& op) const;
  /// The same for values by piece on this rank and vertex; those of vertices on no list stay. Collective.
  template <parallel::Flat T, class Op>
  void combine(std::vector<std::vector<T>>& values, const Op& op) const {
    std::vector<T> copies(size());
    for_each([&](std::size_t p, LocalIndex v, std::size_t copy) { copies[copy] = values[p][v]; });
    reduce_and_scatter(copies, op);
    for_each([&](std::size_t p, LocalIndex v, std::size_t copy) { values[p][v] = copies[copy]; });
  }

  /// Strikes the copies that no other piece knows off this list, and off those of the mesh it was made from.
  /// Returns their number on this rank.
  std::int64_t drop_unshared(DistributedMesh& mesh);

private:
  enum class Kind : std::uint8_t { alone, owner, of_another };
  using Copy = std::uint32_t;
  /// One who knows what a copy here owns: another copy here, or the place of an item that arrives.
  struct Sharer {
    Copy owner, copy_or_place;
    bool is_here;
  };
  /// What it takes to set up: see shared_vertices.cpp.
  struct Link;
  void set_up(const parallel::Communicator& communicator, std::vector<Link> links);
  void renumber(const std::vector<Copy>& number);
  void require_size(std::size_t size) const;

  std::vector<std::size_t> _first{0};
  std::vector<LocalIndex> _vertices;
  std::vector<Kind> _kinds;
  std::vector<Sharer> _sharers;  ///< by owner, then piece
  std::vector<Copy> _outgoing;   ///< whose owners are on other ranks, by rank and number
  std::vector<Copy> _owners;     ///< per item that arrives: whose it is
  parallel::NeighbourExchange _to_owners, _from_owners;
};

template <parallel::Flat T, class Op>
void SharedVertices::reduce(std::vector<T>& copies, const Op& op) const {
  require_size(copies.size());
  std::vector<T> out, arrived(_owners.size());
  out.reserve(_outgoing.size());
  for (const Copy copy : _outgoing) out.push_back(copies[copy]);
  _to_owners.exchange(std::span<const T>(out), std::span<T>(arrived));
  for (const Sharer& sharer : _sharers) {
    const T& value = sharer.is_here ? copies[sharer.copy_or_place] : arrived[sharer.copy_or_place];
    copies[sharer.owner] = op(copies[sharer.owner], value);
  }
}

template <parallel::Flat T>
void SharedVertices::scatter(std::vector<T>& copies) const {
  require_size(copies.size());
  std::vector<T> out, arrived(_outgoing.size());
  out.reserve(_owners.size());
  for (const Copy copy : _owners) out.push_back(copies[copy]);
  _from_owners.exchange(std::span<const T>(out), std::span<T>(arrived));
  for (std::size_t i = 0; i < arrived.size(); ++i) copies[_outgoing[i]] = arrived[i];
  for (const Sharer& sharer : _sharers) {
    if (sharer.is_here) copies[sharer.copy_or_place] = copies[sharer.owner];
  }
}

template <parallel::Flat T, class Op>
void SharedVertices::reduce_and_scatter(std::vector<T>& copies, const Op& op) const {
  reduce(copies, op);
  scatter(copies);
}

}  // namespace aeroloom::mesh
