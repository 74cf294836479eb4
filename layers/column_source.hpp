/// The columns over a triangle or a face of a fan.
#pragma once

#include "layers/column_limits.hpp"
#include "layers/layer_validity.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::layers {

/// What all columns are made from.
struct ColumnSource {
  const LocalWall& wall;
  const Fans& fans;
  const Directions& directions;
  const ColumnLimits& limits;

  /// `column` is one of vertex v.
  CornerColumn at(std::int32_t v, std::int32_t column) const {
    return {wall.points[v],  directions.smoothed[column], limits.heights(v),         limits.count(v),
            wall.ends.get(), directions.ends.at(v),       directions.bend_of(column)};
  }
  TriangleColumns over(std::int32_t triangle) const {
    TriangleColumns columns;
    for (int i = 0; i < 3; ++i) columns[i] = at(wall.triangles[triangle][i], fans.columns[triangle][i]);
    return columns;
  }
  FanColumns over(const FanFace& face) const {
    const std::array<std::int32_t, 2> ends{fans.vertex_of(face.columns[0]), fans.vertex_of(face.columns[2])};
    FanColumns columns;
    columns.over = {face.is_sector(), {limits.count(ends[0]), limits.count(ends[1])}};
    for (int i = 0; i < (face.is_sector() ? 4 : 3); ++i)
      columns.columns[i] = at(ends[i / 2], face.columns[i]);
    return columns;
  }
};

}  // namespace aeroloom::layers
