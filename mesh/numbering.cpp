#include "mesh/delivery.hpp"
#include "mesh/distributed_mesh.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::mesh {

namespace {

/// A shared vertex as one of its pieces knows it.
struct Sharer {
  SharedToken token;
  double coordinates[3];
  PieceId piece;
  LocalIndex vertex;
  std::int64_t rank;
};

/// Tells a piece that another one knows its vertex too.
struct Link {
  PieceId piece;
  LocalIndex vertex;
  PieceId other_piece;
  LocalIndex other_vertex;
  parallel::Rank to, other_rank;
};

/// The global number of a vertex, for a piece that does not own it.
struct Number {
  GlobalIndex number;
  PieceId piece;
  LocalIndex vertex;
};

/// All sharers of a token meet on one rank; sorted by token, then piece.
std::vector<Sharer> meet_by_token(const parallel::Communicator& communicator, const DistributedMesh& mesh) {
  std::vector<Sharer> mine;
  for (const Piece& piece : mesh.pieces) {
    for (std::size_t i = 0; i < piece.shared_vertices.size(); ++i) {
      const LocalIndex v = piece.shared_vertices[i];
      const geometry::Vec3 p = piece.point(v);
      mine.push_back({piece.shared_tokens[i], {p.x, p.y, p.z}, piece.id, v, communicator.rank()});
    }
  }
  auto met = deliver(communicator, std::move(mine), [&](const Sharer& sharer) {
    return meeting_rank(mix_bits(sharer.token), communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const Sharer& a, const Sharer& b) {
    return std::tie(a.token, a.piece, a.vertex) < std::tie(b.token, b.piece, b.vertex);
  });
  return met;
}

/// Throws on all ranks, with the lowest offending vertex, when a piece names a token twice or two pieces
/// disagree on a coordinate bit.
void require_agreement(const parallel::Communicator& communicator, const std::vector<Sharer>& met) {
  struct Clash {
    Sharer first, second;
  };
  std::vector<Clash> clashes;
  std::int64_t count = 0;
  const auto lower = [](const Clash& a, const Clash& b) {
    return std::tie(a.first.piece, a.first.vertex, a.second.piece, a.second.vertex) <
           std::tie(b.first.piece, b.first.vertex, b.second.piece, b.second.vertex);
  };
  for (std::size_t i = 0, first = 0; i < met.size(); ++i) {
    if (met[i].token != met[first].token) first = i;
    if (i == first) continue;
    const bool equal = same_bits(met[i].coordinates, met[first].coordinates);
    if (equal && met[i].piece != met[i - 1].piece) continue;
    ++count;
    const Clash clash{equal ? met[i - 1] : met[first], met[i]};
    if (clashes.empty()) clashes.push_back(clash);
    if (lower(clash, clashes[0])) clashes[0] = clash;
  }
  const auto all = communicator.all_gather_items(std::span<const Clash>(clashes));
  count = communicator.sum(count);
  if (all.empty()) return;
  const auto& [a, b] = *std::min_element(all.begin(), all.end(), lower);
  throw parallel::CollectiveError(
      parallel::FailureKind::bug,
      fmt::format(
          "shared vertices whose pieces disagree: {}. The first: vertex {} of piece {} at ({:.17g}, {:.17g}, "
          "{:.17g}) and vertex {} of piece {} at ({:.17g}, {:.17g}, {:.17g}) have the same token",
          count, a.vertex, a.piece, a.coordinates[0], a.coordinates[1], a.coordinates[2], b.vertex, b.piece,
          b.coordinates[0], b.coordinates[1], b.coordinates[2]));
}

/// The owner, the first of each group, hears of every other piece, and each of those of the owner.
std::vector<Link> announce_sharers(const parallel::Communicator& communicator,
                                   const std::vector<Sharer>& met) {
  std::vector<Link> links;
  for (std::size_t i = 1, first = 0; i < met.size(); ++i) {
    if (met[i].token != met[first].token) {
      first = i;
      continue;
    }
    const Sharer &owner = met[first], &other = met[i];
    const auto owner_rank = static_cast<parallel::Rank>(owner.rank);
    const auto other_rank = static_cast<parallel::Rank>(other.rank);
    links.push_back({owner.piece, owner.vertex, other.piece, other.vertex, owner_rank, other_rank});
    links.push_back({other.piece, other.vertex, owner.piece, owner.vertex, other_rank, owner_rank});
  }
  return deliver(communicator, std::move(links), [](const Link& link) { return link.to; });
}

/// Position in mesh.pieces of a piece that lives here.
std::size_t position_of(const DistributedMesh& mesh, PieceId id) {
  const auto found = std::lower_bound(mesh.pieces.begin(), mesh.pieces.end(), id,
                                      [](const Piece& piece, PieceId wanted) { return piece.id < wanted; });
  return static_cast<std::size_t>(found - mesh.pieces.begin());
}

Numbering mark_owned(const DistributedMesh& mesh, const std::vector<Link>& links) {
  Numbering numbering;
  for (const Piece& piece : mesh.pieces) {
    numbering.vertices.emplace_back(piece.vertex_count(), -1);
    numbering.owned.emplace_back(piece.vertex_count(), 1);
  }
  for (const Link& link : links) {
    if (link.other_piece < link.piece) numbering.owned[position_of(mesh, link.piece)][link.vertex] = 0;
  }
  return numbering;
}

/// The exclusive scan, in the order of piece ids.
void number_owned(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                  Numbering& numbering) {
  struct Counts {
    GlobalIndex vertices, cells;
  };
  std::vector<Counts> counts;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const auto owned = std::count(numbering.owned[i].begin(), numbering.owned[i].end(), 1);
    counts.push_back({owned, mesh.pieces[i].cell_count()});
  }
  std::vector<Counts> first = gather_by_piece(communicator, mesh, counts);
  Counts next{0, 0};
  for (Counts& row : first) {
    const Counts here = row;
    row = next;
    next.vertices += here.vertices, next.cells += here.cells;
  }
  numbering.vertex_count = next.vertices;
  numbering.cell_count = next.cells;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    Counts at = first[mesh.pieces[i].id];
    numbering.first_cell.push_back(at.cells);
    for (std::size_t v = 0; v < numbering.owned[i].size(); ++v) {
      if (numbering.owned[i][v]) numbering.vertices[i][v] = at.vertices++;
    }
  }
}

/// Owners send their numbers straight to the other pieces.
void spread_numbers(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                    const std::vector<Link>& links, Numbering& numbering) {
  struct Addressed {
    Number number;
    std::int64_t to;
  };
  std::vector<Addressed> outgoing;
  for (const Link& link : links) {
    if (link.other_piece < link.piece) continue;
    const GlobalIndex number = numbering.vertices[position_of(mesh, link.piece)][link.vertex];
    outgoing.push_back({{number, link.other_piece, link.other_vertex}, link.other_rank});
  }
  const auto arrived = deliver(communicator, std::move(outgoing),
                               [](const Addressed& item) { return static_cast<parallel::Rank>(item.to); });
  for (const auto& [number, to] : arrived) {
    numbering.vertices[position_of(mesh, number.piece)][number.vertex] = number.number;
  }
}

}  // namespace

Numbering number_mesh(const parallel::Communicator& communicator, const DistributedMesh& mesh) {
  parallel::agree(communicator, [&] {
    for (const Piece& piece : mesh.pieces) require_consistent_arrays(piece);
  });
  std::vector<Link> links;
  {
    const std::vector<Sharer> met = meet_by_token(communicator, mesh);
    require_agreement(communicator, met);
    links = announce_sharers(communicator, met);
  }
  Numbering numbering = mark_owned(mesh, links);
  number_owned(communicator, mesh, numbering);
  spread_numbers(communicator, mesh, links, numbering);
  return numbering;
}

MeshCounts count_mesh(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                      const Numbering& numbering) {
  std::int64_t boundary = 0, inner = 0;
  for (const Piece& piece : mesh.pieces) {
    for (const std::int32_t face : piece.triangle_face) ++(mesh.sides_of(face).is_inner() ? inner : boundary);
  }
  return {numbering.vertex_count, numbering.cell_count, communicator.sum(boundary), communicator.sum(inner)};
}

}  // namespace aeroloom::mesh
