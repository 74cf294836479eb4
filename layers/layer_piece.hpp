/// Makes the layer cells over some triangles of a wall piece.
#pragma once

#include "layers/cap_layout.hpp"
#include "layers/columns.hpp"
#include "layers/lateral_faces.hpp"
#include "layers/layer_shapes.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// A wall piece with everything its layer cells are made from. Keeps references.
struct LayeredPiece {
  const mesh::Piece& wall;
  const mesh::Piece& cap;
  const PieceColumns& columns;
  const CapLayout& layout;
  const std::vector<mesh::GlobalIndex>& wall_numbers;  ///< of the wall's vertices
  const std::vector<mesh::GlobalIndex>& numbers;       ///< of the cap's vertices
  const std::vector<std::uint8_t>& bears;              ///< by triangle: whether it gets layer cells
  std::span<const LateralEdge> laterals;               ///< by half-edge
  /// Of an opened wall, by vertex: find_foot_keys(); else empty.
  std::span<const mesh::SharedVertexKey> foot_keys;
  mesh::RegionId region = 0;
  LayerElements elements = LayerElements::prisms;

  /// Number of layers over a triangle; 0: it stays boundary of the tetrahedra.
  std::int32_t layers_over(mesh::LocalIndex triangle) const;
  std::int32_t cells_over(mesh::LocalIndex triangle) const;
  std::int32_t layers_over(const FanFace& face) const;
  /// Of columns, counter-clockwise seen from the fluid.
  LayersOverTriangle layers_of(const std::array<std::int32_t, 3>& corners) const;
  LayersOverFan layers_of(const FanFace& face) const;
};

/// In LayeredPiece::foot_keys: of a vertex that only its piece knows.
inline constexpr mesh::SharedVertexKey no_foot_key = ~mesh::SharedVertexKey{0};

/// The key in the volume of a vertex of the wall, by its number there and not by that of a column.
mesh::SharedVertexKey wall_vertex_key(mesh::GlobalIndex number);

/// Consecutive triangles of a wall piece.
struct TriangleRange {
  mesh::LocalIndex begin = 0, end = 0;
};

/// Ranges of at most `most_cells` cells, or of a single triangle. Ranges without cells are left out.
std::vector<TriangleRange> cut_into_ranges(const LayeredPiece& source, std::int64_t most_cells);

/// By vertex of the wall piece: whether other pieces or several of the ranges may have it.
std::vector<std::uint8_t> find_shared(const LayeredPiece& source, std::span<const TriangleRange> ranges);

/// Makes the cells over a range as a piece without id. Cap vertices get the shared-vertex keys of the
/// volume's pieces. Other vertices that find_shared() marks get keys of their own.
mesh::Piece make_layer_piece(const LayeredPiece& source, TriangleRange range,
                             const std::vector<std::uint8_t>& shared);

}  // namespace aeroloom::layers
