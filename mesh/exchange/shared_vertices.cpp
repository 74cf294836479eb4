#include "mesh/exchange/shared_vertices.hpp"

#include "mesh/exchange/rendezvous.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::mesh {
namespace {

/// A copy on its way to those with the same key.
struct KeyedCopy {
  std::uint64_t key;
  PieceId piece;
  std::uint32_t copy;
};

std::vector<KeyedVertices> keyed_by_vertex_keys(const DistributedMesh& mesh) {
  std::vector<KeyedVertices> pieces;
  for (const Piece& piece : mesh.pieces)
    pieces.push_back({piece.id, piece.shared_vertices, piece.shared_keys});
  return pieces;
}

/// Adds an item for a partner; partners come one after the other.
void count_item(std::vector<parallel::PartnerItems>& partners, parallel::Rank rank) {
  if (partners.empty() || partners.back().rank != rank) partners.push_back({rank, 0});
  ++partners.back().items;
}

}  // namespace

/// Tells a copy of another one of its vertex: its owner of all others, each of those of the owner.
struct SharedVertices::Link {
  enum class Role : std::int32_t { owner, of_another, twice_in_piece };
  Copy copy, other;
  PieceId other_piece;
  parallel::Rank other_rank;
  Role role;
};

SharedVertices::SharedVertices(const DistributedMesh& mesh)
    : SharedVertices(mesh.communicator, keyed_by_vertex_keys(mesh)) {}

SharedVertices::SharedVertices(const parallel::Communicator& communicator,
                               std::span<const KeyedVertices> pieces)
    : _to_owners(parallel::NeighbourExchange::among_none(communicator)), _from_owners(_to_owners) {
  std::vector<KeyedCopy> mine;
  parallel::agree(communicator, [&] {
    for (const KeyedVertices& piece : pieces) {
      if (piece.vertices.size() != piece.keys.size())
        throw std::logic_error("shared vertices: a piece has not as many keys as vertices");
      for (std::size_t i = 0; i < piece.keys.size(); ++i) {
        mine.push_back({piece.keys[i], piece.piece, static_cast<Copy>(_vertices.size())});
        _vertices.push_back(piece.vertices[i]);
      }
      _first.push_back(_vertices.size());
    }
    if (_vertices.size() > std::numeric_limits<Copy>::max())
      throw std::length_error("shared vertices: too many on one rank");
  });
  const Rendezvous meeting(communicator, mine, &KeyedCopy::key,
                           [](const KeyedCopy& c) { return std::pair(c.piece, c.copy); });
  std::vector<Link> links = meeting.answer<Link>([](const auto& group, const auto& reply) {
    const auto tell = [&](std::size_t whom, std::size_t of, Link::Role role) {
      const KeyedCopy& other = group[of].item;
      reply(group[whom], {group[whom].item.copy, other.copy, other.piece, group[of].from, role});
    };
    for (std::size_t i = 1; i < group.size(); ++i) {
      if (group[i].item.piece == group[i - 1].item.piece) tell(i - 1, i, Link::Role::twice_in_piece);
      tell(0, i, Link::Role::owner);
      tell(i, 0, Link::Role::of_another);
    }
  });
  parallel::agree(communicator, [&] {
    for (const Link& link : links) {
      if (link.role == Link::Role::twice_in_piece)
        throw std::logic_error(fmt::format("shared vertices: vertices {} and {} of piece {} are the same",
                                           _vertices[link.copy], _vertices[link.other], link.other_piece));
    }
  });
  set_up(communicator, std::move(links));
}

// The owner and the one who knows its vertex have to agree on the order of items between their ranks: it is
// that of the latter's copies.
void SharedVertices::set_up(const parallel::Communicator& communicator, std::vector<Link> links) {
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::tie(a.copy, a.other_piece) < std::tie(b.copy, b.other_piece);
  });
  _kinds.assign(_vertices.size(), Kind::alone);
  struct Remote {
    parallel::Rank rank;
    Copy of_sharer;
    std::size_t index;  ///< in _sharers, of what arrives; the copy, of what goes
  };
  std::vector<Remote> arriving, going;
  for (const Link& link : links) {
    const bool is_here = link.other_rank == communicator.rank();
    if (link.role == Link::Role::owner) {
      _kinds[link.copy] = Kind::owner;
      if (!is_here) arriving.push_back({link.other_rank, link.other, _sharers.size()});
      _sharers.push_back({link.copy, link.other, is_here});
    } else {
      _kinds[link.copy] = Kind::of_another;
      if (!is_here) going.push_back({link.other_rank, link.copy, link.copy});
    }
  }
  const auto by_rank = [](const Remote& a, const Remote& b) {
    return std::tie(a.rank, a.of_sharer) < std::tie(b.rank, b.of_sharer);
  };
  std::sort(arriving.begin(), arriving.end(), by_rank);
  std::sort(going.begin(), going.end(), by_rank);
  std::vector<parallel::PartnerItems> sends, receives;
  for (const Remote& item : arriving) {
    count_item(receives, item.rank);
    Sharer& sharer = _sharers[item.index];
    sharer.copy_or_place = static_cast<Copy>(_owners.size());
    _owners.push_back(sharer.owner);
  }
  for (const Remote& item : going) {
    count_item(sends, item.rank);
    _outgoing.push_back(static_cast<Copy>(item.index));
  }
  _to_owners = parallel::NeighbourExchange(communicator, std::move(sends), std::move(receives));
  _from_owners = _to_owners.reversed();
}

std::int64_t SharedVertices::drop_unshared(DistributedMesh& mesh) {
  if (_first.size() != mesh.pieces.size() + 1)
    throw std::logic_error("shared vertices: made from another mesh");
  std::vector<Copy> number(size());
  Copy kept = 0;
  for (std::size_t p = 0, copy = 0; p < mesh.pieces.size(); ++p) {
    Piece& piece = mesh.pieces[p];
    const std::size_t begin = copy, first_kept = kept;
    for (; copy < _first[p + 1]; ++copy) {
      number[copy] = kept;
      if (!is_shared(copy)) continue;
      const std::size_t from = copy - begin, to = kept - first_kept;
      piece.shared_vertices[to] = piece.shared_vertices[from];
      piece.shared_keys[to] = piece.shared_keys[from];
      _vertices[kept] = _vertices[copy];
      _kinds[kept++] = _kinds[copy];
    }
    piece.shared_vertices.resize(kept - first_kept);
    piece.shared_keys.resize(kept - first_kept);
    _first[p] = first_kept;
  }
  _first.back() = kept;
  const auto dropped = static_cast<std::int64_t>(size() - kept);
  _vertices.resize(kept);
  _kinds.resize(kept);
  renumber(number);
  return dropped;
}

// Copies keep their order, and so do the items between ranks.
void SharedVertices::renumber(const std::vector<Copy>& number) {
  for (Sharer& sharer : _sharers) {
    sharer.owner = number[sharer.owner];
    if (sharer.is_here) sharer.copy_or_place = number[sharer.copy_or_place];
  }
  for (Copy& copy : _outgoing) copy = number[copy];
  for (Copy& copy : _owners) copy = number[copy];
}

void SharedVertices::require_size(std::size_t size) const {
  if (size != _vertices.size())
    throw std::logic_error("shared vertices: " + std::to_string(size) + " values for " +
                           std::to_string(_vertices.size()) + " copies");
}

}  // namespace aeroloom::mesh
