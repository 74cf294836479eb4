/// The names of vertices that several pieces may know: made here.
///
/// A shared-vertex key is known by construction, before any numbering. On a surface, CAD vertices are named
/// by their number, vertices of curves and cuts by CAD entity and index, so names ascend by vertex, curve,
/// cut. In a volume, vertices of the surface and points of the lattice are named by running numbers; nodes
/// of boundary layers lie above them, then points that TetGen added, and what rounds over several pieces name
/// lies above everything else.
#pragma once

#include "mesh/data/piece.hpp"

#include <cstdint>

namespace aeroloom::mesh {

// ---- of surfaces ----

/// A CAD vertex.
SharedVertexKey cad_vertex_key(std::int32_t vertex);
/// Vertex `index` inside a CAD edge.
SharedVertexKey curve_vertex_key(std::int32_t edge, std::int32_t index);
/// Vertex `index` on the cuts that one division (`group`, below 2^16) of a CAD face made; index below 2^24,
/// face below 2^22. Throws std::runtime_error beyond that.
SharedVertexKey cut_vertex_key(std::int32_t face, std::int32_t group, std::int32_t index);
/// A vertex of a piece that is shared since the piece was split (split_pieces.hpp); it counts as one on cuts.
SharedVertexKey split_vertex_key(PieceId piece, LocalIndex vertex);

/// Column `column`, 1 to 255, of boundary layers over a vertex: the first one's end has the vertex's own key.
/// Throws std::runtime_error if the vertex cannot name columns: its index is 2^24 or more, on cuts 2^16, of a
/// split piece 2^23.
SharedVertexKey fan_vertex_key(SharedVertexKey vertex, std::int32_t column);
bool can_name_columns(SharedVertexKey vertex);

/// Side `side`, from 1 on, of a vertex at which a surface divides the space into several; side 0 is the
/// vertex. Throws std::runtime_error beyond `last_vertex_side`, and if the vertex cannot name sides: its CAD
/// edge is 2^26 or more, on cuts its face 2^17, of a split piece the piece 2^26.
SharedVertexKey side_vertex_key(SharedVertexKey vertex, int side);
inline constexpr int last_vertex_side = 15;
bool can_name_sides(SharedVertexKey vertex);
/// The vertex that a key of side_vertex_key() is a side of.
SharedVertexKey vertex_key_of_side(SharedVertexKey side);
/// A vertex of a piece that no other piece knew before its sides got names.
SharedVertexKey inside_vertex_key(PieceId piece, LocalIndex vertex);

bool is_cut_vertex_key(SharedVertexKey vertex_key);
/// The CAD edge in the name of a vertex of a curve, -1 for CAD vertices and vertices on cuts.
std::int32_t edge_of_vertex_key(SharedVertexKey vertex_key);
/// The index in the name of a vertex of a curve; the number of a CAD vertex.
std::int32_t index_of_vertex_key(SharedVertexKey vertex_key);

// ---- of volumes ----

/// A vertex known by its running number.
SharedVertexKey running_key(std::int64_t number);
/// A point that TetGen added to a zone: it fits no other zone.
SharedVertexKey added_key(std::int32_t zone, std::int64_t index);
/// Node `node`, below 2^20, of the column of boundary layers over vertex `number`, below 2^40, of the
/// surface.
SharedVertexKey layer_key(std::int64_t number, std::int32_t node);

/// Rounds of cavities that shared-vertex keys tell apart on one mesh.
inline constexpr int most_key_rounds = 255;
/// A vertex of a piece that is shared from a round on.
SharedVertexKey late_key(int round, PieceId piece, LocalIndex vertex);
/// A vertex that a round placed, by a running number.
SharedVertexKey placed_key(int round, std::int64_t index);

}  // namespace aeroloom::mesh
