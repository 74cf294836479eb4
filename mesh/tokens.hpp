/// The names of vertices that several pieces may know: made here.
///
/// A token is known by construction, before any numbering. On a surface, CAD vertices are named by their
/// number, vertices of curves and cuts by CAD entity and index, so names ascend by vertex, curve, cut. In a
/// volume, vertices of the surface and points of the lattice are named by running numbers; points that TetGen
/// added lie above them, and what rounds over several pieces name lies above everything else.
#pragma once

#include "mesh/piece.hpp"

#include <cstdint>

namespace aeroloom::mesh {

// ---- of surfaces ----

/// A CAD vertex.
SharedToken vertex_token(std::int32_t vertex);
/// Vertex `index` inside a CAD edge.
SharedToken curve_token(std::int32_t edge, std::int32_t index);
/// Vertex `index` on the cuts that one division (`group`, below 2^16) of a CAD face made; index below 2^24,
/// face below 2^23. Throws std::runtime_error beyond that.
SharedToken cut_token(std::int32_t face, std::int32_t group, std::int32_t index);

bool is_cut_token(SharedToken token);
/// The CAD edge in the name of a vertex of a curve, -1 for CAD vertices and vertices on cuts.
std::int32_t edge_of_token(SharedToken token);
/// The index in the name of a vertex of a curve; the number of a CAD vertex.
std::int32_t index_of_token(SharedToken token);

// ---- of volumes ----

/// A vertex known by its running number.
SharedToken running_token(std::int64_t number);
/// A point that TetGen added to a zone: it fits no other zone.
SharedToken added_token(std::int32_t zone, std::int64_t index);

/// Rounds of cavities that tokens tell apart on one mesh.
inline constexpr int most_token_rounds = 255;
/// A vertex of a piece that is shared from a round on.
SharedToken late_token(int round, PieceId piece, LocalIndex vertex);
/// A vertex that a round placed, by a running number.
SharedToken placed_token(int round, std::int64_t index);

}  // namespace aeroloom::mesh
