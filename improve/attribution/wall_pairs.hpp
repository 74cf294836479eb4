/// Tetrahedra across a gap between two CAD faces that is narrower than their edges are long.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::attribution {

/// Largest width of a gap over the longest edge of a tetrahedron across it. Chosen, not measured.
inline constexpr double gap_fraction = 0.4;

/// The CAD faces that each vertex of a mesh lies on. For CAD vertices and curves, these are the faces of the
/// boundary triangles around them.
class VertexFaces {
public:
  /// Collective; equal on all ranks.
  VertexFaces(const mesh::DistributedMesh& mesh);

  /// Appends the faces of a vertex, ascending; none for an interior vertex.
  void list(const mesh::Piece& piece, mesh::LocalIndex vertex, std::vector<std::int32_t>& faces) const;

private:
  struct Classification {
    std::int32_t dimension;  // a mesh::CadDimension; as wide as the ids to avoid padding
    std::int32_t entity, face;
    auto operator<=>(const Classification&) const = default;
  };
  std::vector<Classification> _rows;  // of CAD vertices and curves, ascending
};

/// Two faces and the gap between them at a tetrahedron.
struct WallPair {
  std::int32_t low = -1, high = -1;  ///< CAD faces, low < high
  double gap = 0;                    ///< distance between the planes or lines of its vertices on either face
  bool touching = false;             ///< some vertex lies on both
};

/// Finds the faces on both sides of single tetrahedra.
class WallFinder {
public:
  explicit WallFinder(const VertexFaces& of_vertices) : _of_vertices(of_vertices) {}

  /// The nearest two faces that a tetrahedron of the piece connects. Each vertex lies on one of them or both,
  /// and not all on one. The gap is at most `gap_fraction` of the longest edge. Nothing if there are none.
  std::optional<WallPair> find(const mesh::Piece& piece, mesh::LocalIndex tet);

private:
  std::optional<WallPair> measure(std::int32_t low, std::int32_t high,
                                  const std::array<geometry::Vec3, 4>& points) const;
  /// One bit for each vertex on a face.
  unsigned corners_on(std::int32_t face) const;

  const VertexFaces& _of_vertices;
  std::vector<std::int32_t> _faces, _candidates;  // of the four vertices, one after the other; all once
  std::array<std::size_t, 5> _first{};            // first entry of each vertex
};

}  // namespace aeroloom::attribution
