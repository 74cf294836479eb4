/// The cap of an opened wall, closed where there are no layers on either side.
#pragma once

#include "layers/columns.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace aeroloom::layers {

/// Closes the cap of an opened wall: vertices without layers become those of the wall, which all sides share,
/// and triangles without layers on either side the wall's, in the pieces of front sides alone. So each region
/// is enclosed by its cap, or by the wall, and the space of the layers lies between both, outside of all
/// regions. Vertices of pieces stay, and triangles keep their order. Before planes are meshed again.
void glue_cap(const OpenedWall& opened, const Columns& columns, mesh::DistributedMesh& cap);

/// The number in the opened wall's cap of a triangle of a piece of the glued one; `p`: position of the piece.
mesh::LocalIndex triangle_before_gluing(const OpenedWall& opened, const Columns& columns, std::size_t p,
                                        mesh::LocalIndex triangle);

/// By piece of the opened wall and vertex: the key of the wall's vertex in the volume with layers. It is that
/// of the vertex of the glued cap where a side has no layers there; no_foot_key of vertices that only their
/// piece knows. `places`: of the pieces in the cap. Collective.
std::vector<std::vector<mesh::SharedVertexKey>> find_foot_keys(
    const OpenedWall& opened, const Columns& columns, const mesh::NumberedMesh& cap,
    const std::vector<std::optional<std::size_t>>& places);

/// Gives the boundary of a volume with layers the faces and patches of the wall; triangles of inner faces
/// stay on the front side alone.
void close_inner_faces(const OpenedWall& opened, mesh::DistributedMesh& volume);

}  // namespace aeroloom::layers
