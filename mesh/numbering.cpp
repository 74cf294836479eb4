#include "mesh/delivery.hpp"
#include "mesh/distributed_mesh.hpp"
#include "mesh/mixing.hpp"
#include "mesh/shared_vertices.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::mesh {

namespace {

/// A shared vertex as one of its pieces knows it.
struct Knower {
  double coordinates[3];
  PieceId piece;
  LocalIndex vertex;

  static constexpr auto fields() { return std::tuple(&Knower::coordinates, &Knower::piece, &Knower::vertex); }
};

/// Throws on all ranks, with the lowest offending vertex, when two pieces disagree on a coordinate bit.
void require_agreement(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                       const SharedVertices& shared) {
  struct Clash {
    Knower first, second;
    static constexpr auto fields() { return std::tuple(&Clash::first, &Clash::second); }
  };
  std::vector<Knower> mine(shared.size());
  shared.for_each([&](std::size_t p, LocalIndex v, std::size_t copy) {
    const geometry::Vec3 at = mesh.pieces[p].point(v);
    mine[copy] = {{at.x, at.y, at.z}, mesh.pieces[p].id, v};
  });
  std::vector<Knower> owners = mine;
  shared.scatter(owners);
  std::vector<Clash> clashes;
  std::int64_t count = 0;
  const auto lower = [](const Clash& a, const Clash& b) {
    return std::tie(a.first.piece, a.first.vertex, a.second.piece, a.second.vertex) <
           std::tie(b.first.piece, b.first.vertex, b.second.piece, b.second.vertex);
  };
  for (std::size_t copy = 0; copy < mine.size(); ++copy) {
    if (same_bits(mine[copy].coordinates, owners[copy].coordinates)) continue;
    ++count;
    const Clash clash{owners[copy], mine[copy]};
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

Numbering mark_owned(const DistributedMesh& mesh, const SharedVertices& shared) {
  Numbering numbering;
  for (const Piece& piece : mesh.pieces) {
    numbering.vertices.emplace_back(piece.vertex_count(), -1);
    numbering.owned.emplace_back(piece.vertex_count(), 1);
  }
  shared.for_each([&](std::size_t p, LocalIndex v, std::size_t copy) {
    if (!shared.is_owned(copy)) numbering.owned[p][v] = 0;
  });
  return numbering;
}

/// The exclusive scan, in the order of piece ids.
void number_owned(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                  Numbering& numbering) {
  struct Counts {
    GlobalIndex vertices, cells;

    static constexpr auto fields() { return std::tuple(&Counts::vertices, &Counts::cells); }
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

/// All pieces learn the numbers of owners.
void spread_numbers(const SharedVertices& shared, Numbering& numbering) {
  std::vector<GlobalIndex> numbers(shared.size());
  shared.for_each(
      [&](std::size_t p, LocalIndex v, std::size_t copy) { numbers[copy] = numbering.vertices[p][v]; });
  shared.scatter(numbers);
  shared.for_each(
      [&](std::size_t p, LocalIndex v, std::size_t copy) { numbering.vertices[p][v] = numbers[copy]; });
}

}  // namespace

Numbering number_mesh(const parallel::Communicator& communicator, const DistributedMesh& mesh) {
  parallel::agree(communicator, [&] {
    for (const Piece& piece : mesh.pieces) require_consistent_arrays(piece);
  });
  const SharedVertices shared(communicator, mesh);
  require_agreement(communicator, mesh, shared);
  Numbering numbering = mark_owned(mesh, shared);
  number_owned(communicator, mesh, numbering);
  spread_numbers(shared, numbering);
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
