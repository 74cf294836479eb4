/// A background triangulation as the partitioner sees it.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::partition {

using TriangleIndex = std::int32_t;  ///< of a background triangle
using ClusterIndex = std::int32_t;   ///< of a node of the simplified dual graph
using PartIndex = std::int32_t;      ///< of a part of the background
using FanIndex = std::int32_t;       ///< of a fan of triangles around a vertex, in VertexFans

/// An oriented triangulation, coarse compared with the mesh to come. An edge with a triangle on one side
/// alone is a feature curve, or a cut of an earlier division. Pieces end there in any decomposition.
struct BackgroundSurface {
  std::vector<geometry::Vec3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<geometry::HalfEdge> twins;  ///< per half-edge: the opposite one, -1 on a feature curve
  std::vector<double> loads;              ///< per triangle: predicted triangles of the fine mesh

  std::int32_t start(geometry::HalfEdge h) const { return triangles[h / 3][h % 3]; }
  std::int32_t end(geometry::HalfEdge h) const { return start(geometry::next_half_edge(h)); }
};

/// The triangles around each vertex in counter-clockwise order. A vertex where feature curves touch may have
/// several fans.
struct VertexFans {
  std::vector<geometry::HalfEdge> corners;  ///< half-edges that start at the vertex, fan by fan
  std::vector<std::int32_t> first;          ///< (fans + 1) into corners
  std::vector<char> closed;                 ///< per fan: 1 around an interior vertex
  std::vector<double> angles;               ///< per corner, degrees

  FanIndex count() const { return static_cast<FanIndex>(closed.size()); }
  std::int32_t size(FanIndex fan) const { return first[fan + 1] - first[fan]; }
  /// The half-edge of edge i of a fan, in a triangle beside it. Edge i lies before corner i; an open fan has
  /// one more edge at its end.
  geometry::HalfEdge edge(FanIndex fan, std::int32_t i) const {
    return i < size(fan) ? corners[first[fan] + i]
                         : geometry::previous_half_edge(corners[first[fan + 1] - 1]);
  }
  std::int32_t edge_count(FanIndex fan) const { return size(fan) + (closed[fan] ? 0 : 1); }
};

/// All fans, in the order of their first corners. An open fan begins at a feature curve.
VertexFans gather_fans(const BackgroundSurface& surface);

/// The part of a fan from edge `from` to edge `to`. Its angle is counted counter-clockwise.
struct FanWedge {
  FanIndex fan;
  std::int32_t from, to;
  double angle;  ///< degrees
};

}  // namespace aeroloom::partition
