#include "mesh/boundary_mesh.hpp"
#include "mesh/delivery.hpp"
#include "mesh/mixing.hpp"
#include "mesh/validity_checks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
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
  std::int32_t unused = 0;  ///< no padding travels
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

std::uint64_t mixed_bits(const BitTriangle& triangle) {
  std::uint64_t mixed = 0;
  for (const PointBits& corner : triangle.corners) {
    for (const std::uint64_t word : corner) mixed = mix_in(mixed, word);
  }
  return mixed;
}

Offender offender_of(const BitTriangle& triangle) {
  return {{triangle.piece, triangle.triangle}, triangle.piece, Entity::triangle, triangle.triangle};
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

void check_same_triangles(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                          const DistributedMesh& surface, Findings& in_mesh, Findings& in_surface) {
  parallel::agree(communicator, [&] {
    for (const Piece& piece : surface.pieces) require_consistent_arrays(piece);
  });
  // A surface made of the mesh itself: nothing needs to travel.
  if (communicator.minimum(std::int64_t{are_same_in_order(mesh, surface)}) == 1) return;
  std::vector<BitTriangle> triangles;
  add_triangles(mesh, Side::mesh, triangles);
  add_triangles(surface, Side::surface, triangles);
  std::vector<BitTriangle> met = deliver(
      communicator, std::move(triangles),
      [&](const BitTriangle& triangle) { return meeting_rank(mixed_bits(triangle), communicator.size()); });
  const auto place = [](const BitTriangle& t) { return std::tuple(t.side, t.piece, t.triangle); };
  std::sort(met.begin(), met.end(), [&](const BitTriangle& a, const BitTriangle& b) {
    return a.corners != b.corners ? a.corners < b.corners : place(a) < place(b);
  });
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    std::size_t of_mesh = 0;
    for (; j < met.size() && met[j].corners == met[i].corners; ++j)
      of_mesh += met[j].side == Side::mesh ? 1 : 0;
    // Those of the mesh come first in the group: what either side has beyond the other is left over.
    const std::size_t middle = i + of_mesh, common = std::min(of_mesh, j - middle);
    for (std::size_t k = i + common; k < middle; ++k) {
      in_mesh.add(Violation::triangle_not_in_surface, offender_of(met[k]));
    }
    for (std::size_t k = middle + common; k < j; ++k) {
      in_surface.add(Violation::triangle_missing_from_mesh, offender_of(met[k]));
    }
  }
}

}  // namespace aeroloom::mesh
