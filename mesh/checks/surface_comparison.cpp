#include "mesh/checks/validity_checks.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

namespace {

using PointBits = std::array<std::uint64_t, 3>;

PointBits bits_of(geometry::Vec3 p) {
  return {std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
          std::bit_cast<std::uint64_t>(p.z)};
}

enum class Side : std::int32_t { mesh, surface };

/// A triangle by the bits of its corners, lowest corner first, orientation kept.
struct BitTriangle {
  std::array<PointBits, 3> corners;
  PieceId piece;
  LocalIndex triangle;
  Side side;
};

BitTriangle make_triangle(const Piece& piece, LocalIndex t, Side side) {
  BitTriangle result{{}, piece.id, t, side};
  for (int k = 0; k < 3; ++k) {
    result.corners[k] = bits_of(piece.point(piece.boundary_triangle(t)[k]));
  }
  const auto lowest = std::min_element(result.corners.begin(), result.corners.end());
  std::rotate(result.corners.begin(), lowest, result.corners.end());
  return result;
}

void add_triangles(const DistributedMesh& mesh, Side side, std::vector<BitTriangle>& triangles) {
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t)
      triangles.push_back(make_triangle(piece, t, side));
  }
}

Offender offender_of(const BitTriangle& triangle) {
  return {{triangle.piece, triangle.triangle}, triangle.piece, Entity::boundary_face, triangle.triangle};
}

/// Whether the surface has the triangles of the mesh one after the other, as boundary_mesh makes it.
bool are_same_in_order(const DistributedMesh& mesh, const DistributedMesh& surface) {
  auto skin = surface.pieces.begin();
  LocalIndex next = 0;
  for (const Piece& piece : mesh.pieces) {
    for (const LocalIndex t : triangles_by_face(piece)) {
      while (skin != surface.pieces.end() && next == skin->boundary_count()) ++skin, next = 0;
      if (skin == surface.pieces.end()) return false;
      const LocalIndex *here = piece.boundary_triangle(t), *there = skin->boundary_triangle(next++);
      for (int k = 0; k < 3; ++k) {
        if (bits_of(piece.point(here[k])) != bits_of(skin->point(there[k]))) return false;
      }
    }
  }
  while (skin != surface.pieces.end() && next == skin->boundary_count()) ++skin, next = 0;
  return skin == surface.pieces.end();
}

}  // namespace

void check_same_triangles(const DistributedMesh& mesh, const DistributedMesh& surface, Findings& in_mesh,
                          Findings& in_surface) {
  const parallel::Communicator& communicator = mesh.communicator;
  parallel::agree(communicator, [&] {
    for (const Piece& piece : surface.pieces) require_consistent_arrays(piece);
  });
  // A surface made of the mesh itself: nothing needs to travel.
  if (communicator.minimum(std::int64_t{are_same_in_order(mesh, surface)}) == 1) return;
  std::vector<BitTriangle> triangles;
  add_triangles(mesh, Side::mesh, triangles);
  add_triangles(surface, Side::surface, triangles);
  const std::vector<BitTriangle> met =
      meet_by_key(communicator, std::move(triangles), &BitTriangle::corners,
                  [](const BitTriangle& t) { return std::tie(t.side, t.piece, t.triangle); });
  for_each_key(met, &BitTriangle::corners, [&](std::span<const BitTriangle> group) {
    // Triangles of the mesh come first: what either side has beyond the other is left over.
    const auto of_mesh = static_cast<std::size_t>(
        std::count_if(group.begin(), group.end(), [](const BitTriangle& t) { return t.side == Side::mesh; }));
    const std::size_t common = std::min(of_mesh, group.size() - of_mesh);
    for (const BitTriangle& t : group.subspan(common, of_mesh - common))
      in_mesh.add(Violation::triangle_not_in_surface, offender_of(t));
    for (const BitTriangle& t : group.subspan(of_mesh + common))
      in_surface.add(Violation::triangle_missing_from_mesh, offender_of(t));
  });
}

}  // namespace aeroloom::mesh
