/// Tetrahedra that reach from one wall to another: two CAD faces so near to each other that their elements
/// are longer than the space between is wide.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace aeroloom::attribution {

/// A tetrahedron reaches between walls where they are apart by at most this fraction of its longest edge.
/// Chosen, not measured.
inline constexpr double gap_fraction = 0.4;

/// Which CAD faces the vertices of a mesh lie on. Those of CAD vertices and curves are read off the boundary
/// triangles around them.
class VertexFaces {
public:
  /// Collective; the same on every rank.
  VertexFaces(const mesh::DistributedMesh& mesh);

  /// Appends the faces of a vertex, ascending; none of a vertex inside a region.
  void list(const mesh::Piece& piece, mesh::LocalIndex vertex, std::vector<std::int32_t>& faces) const;

private:
  struct Classification {
    std::int32_t dimension;  // a mesh::CadDimension; as wide as the ids, so that there is no padding
    std::int32_t entity, face;

    static constexpr auto fields() {
      return std::tuple(&Classification::dimension, &Classification::entity, &Classification::face);
    }
    auto operator<=>(const Classification&) const = default;
  };
  std::vector<Classification> _rows;  // of CAD vertices and curves, ascending
};

/// Two faces with what a tetrahedron says of the space between them.
struct WallPair {
  std::int32_t low = -1, high = -1;  ///< the faces, low < high
  double gap = 0;                    ///< between the planes or lines of its vertices on either
  bool touching = false;             ///< some vertex lies on both
};

/// Finds walls, one tetrahedron after the other.
class WallFinder {
public:
  explicit WallFinder(const VertexFaces& of_vertices) : _of_vertices(of_vertices) {}

  /// The nearest two faces that a tetrahedron of the piece reaches between: each of its vertices lies on one
  /// of them or both, not all of them on one, and the faces are apart there by at most `gap_fraction` of its
  /// longest edge. Nothing where there are none.
  std::optional<WallPair> find(const mesh::Piece& piece, mesh::LocalIndex tet);

private:
  std::optional<WallPair> measure(std::int32_t low, std::int32_t high,
                                  const std::array<geometry::Vec3, 4>& points) const;
  /// The bits of the vertices that lie on a face.
  unsigned corners_on(std::int32_t face) const;

  const VertexFaces& _of_vertices;
  std::vector<std::int32_t> _faces, _candidates;  // of the four vertices, one after the other; all once
  std::array<std::size_t, 5> _first{};            // of a vertex among them
};

}  // namespace aeroloom::attribution
