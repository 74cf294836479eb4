/// A uniform grid over triangles of the plane, to find the triangle at a point.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::geometry {

/// Lists for each cell the triangles that meet it. Cells are about as large as the triangles. Triangles that
/// are not counter-clockwise are left out.
class PlaneGrid {
public:
  PlaneGrid(const std::vector<Vec2>& points, const std::vector<std::array<std::int32_t, 3>>& triangles);

  std::int32_t columns() const { return _columns; }
  std::int32_t rows() const { return _rows; }
  double cell_size() const { return _cell; }
  /// Column and row of the cell at the point; the nearest cell for points outside the grid.
  std::array<std::int32_t, 2> cell_of(Vec2 point) const;
  std::span<const std::int32_t> triangles_in(std::int32_t column, std::int32_t row) const;

private:
  /// Calls visit(cell) for the cells a triangle meets.
  template <class Visit>
  void for_each_cell(const std::array<Vec2, 3>& corners, Visit visit) const;

  Vec2 _low;
  double _cell = 1;
  std::int32_t _columns = 1, _rows = 1;
  std::vector<std::int32_t> _begin;  // (cells + 1) into _triangles
  std::vector<std::int32_t> _triangles;
};

}  // namespace aeroloom::geometry
