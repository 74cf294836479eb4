/// Fans: several columns on the vertices of sharp convex edges, which divide the angle there.
#pragma once

#include "layers/sectors.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::layers {

/// The columns of a wall. Most vertices have one, those of ridges several, all of the same heights.
struct Fans {
  std::vector<std::int32_t> first;          ///< (vertices + 1) columns of each vertex
  std::vector<std::int32_t> vertices;       ///< by column; empty where all vertices have one
  std::vector<geometry::Vec3> directions;   ///< by column; of vertices with one, zero
  std::vector<double> visibility, leans;    ///< of vertices with several, as Directions has them; else 0
  std::vector<LocalWall::Corners> columns;  ///< by triangle: of its corners
  std::vector<FanFace> faces;               ///< by triangle
  std::vector<RimTriangle> rims;            ///< by triangle
  std::vector<std::int32_t> is_end;         ///< by vertex: 1 where a fan ends on a wall, without layers
  std::vector<std::int32_t> first_around, around;  ///< faces by vertex, as LocalWall has triangles

  std::int32_t column_count() const { return first.back(); }
  std::int32_t count_at(std::int32_t vertex) const { return first[vertex + 1] - first[vertex]; }
  std::int32_t vertex_of(std::int32_t column) const { return vertices.empty() ? column : vertices[column]; }
  std::span<const std::int32_t> faces_around(std::int32_t vertex) const {
    return std::span(around).subspan(first_around[vertex], first_around[vertex + 1] - first_around[vertex]);
  }
};

/// One column on each vertex.
Fans without_fans(const LocalWall& wall);

/// Fans along ridges, with the sectors of count_sectors(). Where three ridges and more meet, what lies
/// between their fans is filled. Collective.
Fans find_fans(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs);

}  // namespace aeroloom::layers
