/// A background triangulation as its decomposition sees it.
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
using FanIndex = std::int32_t;       ///< of the triangles around a vertex, in VertexFans

/// An oriented triangulation, coarse next to the mesh to come. Edges with a triangle on one side alone are
/// feature curves, or cuts of a division before: they bound pieces whatever the decomposition.
struct BackgroundSurface {
  std::vector<geometry::Vec3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<geometry::HalfEdge> twins;  ///< per half-edge: the opposite one, -1 on a feature curve
  std::vector<double> loads;              ///< per triangle: predicted triangles of the fine mesh

  std::int32_t start(geometry::HalfEdge h) const { return triangles[h / 3][h % 3]; }
  std::int32_t end(geometry::HalfEdge h) const { return start(geometry::next_half_edge(h)); }
};

/// The triangles around a vertex in counter-clockwise order. A vertex where feature curves touch may have
/// several fans.
struct VertexFans {
  std::vector<geometry::HalfEdge> corners;  ///< half-edges that start at the vertex, fan by fan
  std::vector<std::int32_t> first;          ///< (fans + 1) into corners
  std::vector<char> closed;                 ///< per fan: 1 around an interior vertex
  std::vector<double> angles;               ///< per corner, degrees

  FanIndex count() const { return static_cast<FanIndex>(closed.size()); }
  std::int32_t size(FanIndex fan) const { return first[fan + 1] - first[fan]; }
  /// Edges leave the vertex between corners: edge i of a fan lies before its corner i; an open fan ends with
  /// one more. This is its half-edge in one of the triangles beside it.
  geometry::HalfEdge edge(FanIndex fan, std::int32_t i) const {
    return i < size(fan) ? corners[first[fan] + i]
                         : geometry::previous_half_edge(corners[first[fan + 1] - 1]);
  }
  std::int32_t edge_count(FanIndex fan) const { return size(fan) + (closed[fan] ? 0 : 1); }
};

/// Fans in the order of their first corners (open ones begin at a feature curve).
VertexFans gather_fans(const BackgroundSurface& surface);

/// Stretches of a fan between two of its edges: `from` and `to` are edge numbers, the angle between them is
/// counted counter-clockwise.
struct FanWedge {
  FanIndex fan;
  std::int32_t from, to;
  double angle;  ///< degrees
};

}  // namespace aeroloom::partition
