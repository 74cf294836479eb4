/// Background tetrahedra as their decomposition sees them.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// An angle of the surface between two chords that leave a corner on either side of a cell: the boundary
/// tetrahedron inside, and those across the two chords.
struct TraceCorner {
  std::int32_t inside, before, after;  ///< tetrahedra; before or after may be -1
  double angle;                        ///< degrees
};

/// Coarse tetrahedra of one region, with positive volume in VTK's order.
struct BackgroundVolume {
  std::vector<geometry::Vec3> points;
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::array<std::int32_t, 4>> neighbours;    ///< across the face opposite vertex k; -1: boundary
  std::vector<double> loads;                              ///< per tet: predicted fine tetrahedra
  std::vector<double> sizes;                              ///< per tet: mean fine size
  std::vector<std::int8_t> closed_vertices;               ///< per point: 1 where no cut may pass
  std::vector<std::array<std::int32_t, 2>> closed_edges;  ///< boundary edges no cut may pass; ends ascending
  std::vector<TraceCorner> corners;
};

/// The neighbours of tetrahedra; -1 where there is none.
std::vector<std::array<std::int32_t, 4>> link_tetrahedra(
    const std::vector<std::array<std::int32_t, 4>>& tets);

/// The tetrahedra around the edges, in order. Around an inner edge the ring is closed; an edge of the
/// boundary has an open fan from boundary face to boundary face, several where the boundary touches itself.
struct EdgeRings {
  std::vector<std::array<std::int32_t, 2>> edges;  ///< per ring, ends ascending
  std::vector<std::int8_t> closed;                 ///< per ring
  std::vector<std::int32_t> first;                 ///< (rings + 1) into tets
  std::vector<std::int32_t> tets;
  std::vector<double> angles;  ///< per entry: dihedral angle, degrees

  std::int32_t count() const { return static_cast<std::int32_t>(edges.size()); }
  std::int32_t size(std::int32_t ring) const { return first[ring + 1] - first[ring]; }
};

EdgeRings gather_rings(const BackgroundVolume& volume);

/// A stretch of a ring between two cuts, or a cut and the boundary: entries from (included) to (excluded),
/// counted on past the end of a closed ring.
struct Stretch {
  std::int32_t from, to;
  double angle;  ///< degrees
};

/// The stretches of tetrahedra with equal labels around one edge; one stretch without cuts if all are equal.
void find_stretches(const EdgeRings& rings, std::int32_t ring, const std::vector<std::int32_t>& label,
                    std::vector<Stretch>& stretches);

}  // namespace aeroloom::partition
