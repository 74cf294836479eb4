/// The cells over some triangles of a piece of the wall.
#pragma once

#include "layers/columns.hpp"
#include "layers/lateral_faces.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// A piece of the wall with all that its layers are made of. Refers to what lives elsewhere.
struct LayeredPiece {
  const mesh::Piece& wall;
  const mesh::Piece& cap;
  const PieceColumns& columns;
  const std::vector<mesh::GlobalIndex>& numbers;  ///< of the cap's vertices
  const std::vector<std::uint8_t>& bears;         ///< by triangle
  std::span<const LateralEdge> laterals;          ///< by half-edge
  mesh::RegionId region = 0;
  LayerElements elements = LayerElements::prisms;

  /// Layers over a triangle; 0: it stays boundary of what lies beyond the cap.
  std::int32_t layers_over(mesh::LocalIndex triangle) const;
  std::int32_t cells_over(mesh::LocalIndex triangle) const;
};

/// Consecutive triangles.
struct TriangleRange {
  mesh::LocalIndex begin = 0, end = 0;
};

/// Ranges with at most so many cells each, or one triangle; those without cells are left out.
std::vector<TriangleRange> cut_into_ranges(const LayeredPiece& source, std::int64_t most_cells);

/// The vertices of the wall's piece that other pieces may know, or several of the ranges. By vertex.
std::vector<std::uint8_t> find_shared(const LayeredPiece& source, std::span<const TriangleRange> ranges);

/// The cells over the triangles of a range as a piece without an id. Vertices of the cap have the key that
/// the volume's pieces give them, others that may be shared, by find_shared(), keys of their own.
mesh::Piece make_layer_piece(const LayeredPiece& source, TriangleRange range,
                             const std::vector<std::uint8_t>& shared);

}  // namespace aeroloom::layers
