/// Decides whether points of the parameter plane lie inside the loops of a face. Internal to cad/model/.
#pragma once

#include "cad/model/model_data.hpp"

#include <cstdint>
#include <vector>

#include <BRepTopAdaptor_FClass2d.hxx>

namespace aeroloom::cad {

/// A grid over the box of the loops. Near loops the CAD library classifies each point. All other cells are
/// classified once, by connected sets.
class SheetInterior {
public:
  explicit SheetInterior(const FaceEvaluator& face);

  /// Inside the loops or on them.
  bool contains(Vec2 uv) const;

private:
  enum class Cell : std::uint8_t { unknown, near_loop, inside, outside };

  static constexpr int cells_per_side = 256;

  Vec2 grid_place(Vec2 uv) const;
  void mark_curve(const UseCurve& use);
  void mark_cells_around(Vec2 place);
  void classify_cells();
  void spread(int start, Cell cell);
  bool classify_by_library(Vec2 uv) const;

  bool _periodic;
  Vec2 _box_low, _box_high;  // of the loops
  Vec2 _grid_low, _cell_size;
  std::vector<Cell> _cells;  // row by row along u
  BRepTopAdaptor_FClass2d _library;
};

}  // namespace aeroloom::cad
