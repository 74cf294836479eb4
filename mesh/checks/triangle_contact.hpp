/// The exact decision whether two triangles of a surface meet where they must not.
#pragma once

#include "geometry/vec.hpp"

#include <compare>
#include <cstdint>
#include <tuple>

namespace aeroloom::mesh {

/// The name of a vertex over all pieces: its shared-vertex key with piece -1, or its index in its piece.
struct VertexName {
  std::int64_t piece = -1;
  std::uint64_t id = 0;
  friend bool operator==(const VertexName&, const VertexName&) = default;
};

/// A triangle with named corners.
struct NamedTriangle {
  geometry::Vec3 points[3];
  VertexName names[3];

  static constexpr auto fields() { return std::tuple(&NamedTriangle::points, &NamedTriangle::names); }
};

/// Whether the closed triangles share a point outside their common vertices and edge. Two triangles with
/// three common vertices do; so does a triangle without area with one that shares an edge with it. Exact.
bool meet_wrongly(const NamedTriangle& a, const NamedTriangle& b);

}  // namespace aeroloom::mesh
