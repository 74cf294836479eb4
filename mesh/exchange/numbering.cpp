#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/exchange/delivery.hpp"
#include "mesh/exchange/shared_vertices.hpp"

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
void require_agreement(const DistributedMesh& mesh, const SharedVertices& shared) {
  const parallel::Communicator& communicator = mesh.communicator;
  struct Clash {
    Knower first, second;
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
          "{:.17g}) and vertex {} of piece {} at ({:.17g}, {:.17g}, {:.17g}) have the same shared-vertex key",
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

/// Vertices in turn, in the order of piece ids.
void number_owned(const DistributedMesh& mesh, Numbering& numbering) {
  std::vector<GlobalIndex> counts;
  for (const auto& owned : numbering.owned) counts.push_back(std::count(owned.begin(), owned.end(), 1));
  const std::vector<GlobalIndex> first = first_by_piece(mesh, counts);
  numbering.vertex_count = first.back();
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    GlobalIndex next = first[i];
    for (std::size_t v = 0; v < numbering.owned[i].size(); ++v) {
      if (numbering.owned[i][v]) numbering.vertices[i][v] = next++;
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

NumberedMesh number_mesh(DistributedMesh mesh) {
  parallel::agree(mesh.communicator, [&] {
    for (const Piece& piece : mesh.pieces) require_consistent_arrays(piece);
  });
  Numbering numbering = find_numbers(mesh, SharedVertices(mesh));
  return {std::move(mesh), std::move(numbering)};
}

Numbering find_numbers(const DistributedMesh& mesh, const SharedVertices& shared) {
  require_agreement(mesh, shared);
  Numbering numbering = mark_owned(mesh, shared);
  number_owned(mesh, numbering);
  number_cells(mesh, numbering);
  spread_numbers(shared, numbering);
  return numbering;
}

void number_cells(const DistributedMesh& mesh, Numbering& numbering) {
  std::vector<GlobalIndex> counts;
  for (const Piece& piece : mesh.pieces) counts.push_back(piece.total_cell_count());
  numbering.first_cell = first_by_piece(mesh, counts);
  numbering.cell_count = numbering.first_cell.back();
  numbering.first_cell.pop_back();
}

MeshCounts count_mesh(const NumberedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  MeshCounts mine{mesh.numbering.vertex_count, mesh.numbering.cell_count};
  for (const Piece& piece : mesh.pieces) {
    for (const std::int32_t face : piece.triangle_face)
      ++(mesh.sides_of(face).is_inner() ? mine.inner_triangles : mine.boundary_triangles);
    for (const std::int32_t face : piece.quad_face)
      ++(mesh.sides_of(face).is_inner() ? mine.inner_quads : mine.boundary_quads);
    mine.pyramids += static_cast<GlobalIndex>(piece.pyramids.size() / 5);
    mine.prisms += static_cast<GlobalIndex>(piece.prisms.size() / 6);
    mine.hexahedra += static_cast<GlobalIndex>(piece.hexahedra.size() / 8);
  }
  for (GlobalIndex* count : {&mine.boundary_triangles, &mine.inner_triangles, &mine.pyramids, &mine.prisms,
                             &mine.hexahedra, &mine.boundary_quads, &mine.inner_quads})
    *count = communicator.sum(*count);
  return mine;
}

}  // namespace aeroloom::mesh
