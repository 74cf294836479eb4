#include "cad/model/topology/sheet_interior.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <gp_Pnt2d.hxx>

namespace aeroloom::cad {
namespace {

// In cells: how far apart points of a loop are taken, and how far around them its cells lie.
constexpr double longest_step = 0.5, margin = 0.75;
// Parts of a curve to begin with, so that none that bends back is missed, and how often each is halved: 4096
// times as short gets to `longest_step` on any curve that is not a needle in parameters.
constexpr int first_steps = 32, halvings = 12;

}  // namespace

SheetInterior::SheetInterior(const FaceEvaluator& face)
    : _periodic(face.u.period > 0 || face.v.period > 0),
      _box_low(face.uv_low),
      _box_high(face.uv_high),
      _cells(cells_per_side * cells_per_side, Cell::unknown),
      _library(face.shape, tolerances::on_loop) {
  // Two rows of cells on each side of the box: one of them is not beside a loop.
  _cell_size = (1.0 / (cells_per_side - 4)) * (_box_high - _box_low);
  _grid_low = _box_low - 2.0 * _cell_size;
  for (const UseCurve& use : face.uses) mark_curve(use);
  classify_cells();
}

/// In cells from the grid's corner.
Vec2 SheetInterior::grid_place(Vec2 uv) const {
  return {(uv.x - _grid_low.x) / _cell_size.x, (uv.y - _grid_low.y) / _cell_size.y};
}

void SheetInterior::mark_curve(const UseCurve& use) {
  const auto place_at = [&](double parameter) {
    const gp_Pnt2d uv = use.curve.Value(parameter);
    return grid_place({uv.X(), uv.Y()});
  };
  const auto apart = [](Vec2 a, Vec2 b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); };
  struct Interval {
    double first, last;
    int depth;
  };
  std::vector<Interval> waiting;
  waiting.reserve(first_steps + halvings);
  const double step = (use.last - use.first) / first_steps;
  for (int i = 0; i < first_steps; ++i)
    waiting.push_back({use.first + i * step, use.first + (i + 1) * step, 0});
  while (!waiting.empty()) {
    const Interval stretch = waiting.back();
    waiting.pop_back();
    const double middle = 0.5 * (stretch.first + stretch.last);
    const Vec2 a = place_at(stretch.first), b = place_at(middle), c = place_at(stretch.last);
    for (const Vec2 place : {a, b, c}) mark_cells_around(place);
    if (stretch.depth == halvings || std::max(apart(a, b), apart(b, c)) <= longest_step) continue;
    waiting.push_back({stretch.first, middle, stretch.depth + 1});
    waiting.push_back({middle, stretch.last, stretch.depth + 1});
  }
}

void SheetInterior::mark_cells_around(Vec2 place) {
  const auto cell = [](double at) { return std::clamp(static_cast<int>(at), 0, cells_per_side - 1); };
  for (int row = cell(place.y - margin); row <= cell(place.y + margin); ++row) {
    for (int column = cell(place.x - margin); column <= cell(place.x + margin); ++column) {
      _cells[row * cells_per_side + column] = Cell::near_loop;
    }
  }
}

void SheetInterior::classify_cells() {
  for (int i = 0; i < cells_per_side * cells_per_side; ++i) {
    if (_cells[i] != Cell::unknown) continue;
    const int column = i % cells_per_side, row = i / cells_per_side;
    const Vec2 middle{_grid_low.x + (column + 0.5) * _cell_size.x, _grid_low.y + (row + 0.5) * _cell_size.y};
    spread(i, classify_by_library(middle) ? Cell::inside : Cell::outside);
  }
}

/// To all cells that can be reached from one without crossing a loop.
void SheetInterior::spread(int start, Cell cell) {
  std::vector<int> waiting{start};
  _cells[start] = cell;
  const auto visit = [&](int next) {
    if (_cells[next] != Cell::unknown) return;
    _cells[next] = cell;
    waiting.push_back(next);
  };
  while (!waiting.empty()) {
    const int at = waiting.back(), column = at % cells_per_side, row = at / cells_per_side;
    waiting.pop_back();
    if (column > 0) visit(at - 1);
    if (column + 1 < cells_per_side) visit(at + 1);
    if (row > 0) visit(at - cells_per_side);
    if (row + 1 < cells_per_side) visit(at + cells_per_side);
  }
}

bool SheetInterior::contains(Vec2 uv) const {
  const bool in_box = uv.x >= _box_low.x && uv.x <= _box_high.x && uv.y >= _box_low.y && uv.y <= _box_high.y;
  // Beyond the box points of a periodic direction may be those of the other end.
  if (!in_box && _periodic) return classify_by_library(uv);
  const Vec2 place = grid_place(uv);
  const bool in_grid = place.x >= 0 && place.x < cells_per_side && place.y >= 0 && place.y < cells_per_side;
  if (!in_grid) return false;
  const Cell cell = _cells[static_cast<int>(place.y) * cells_per_side + static_cast<int>(place.x)];
  return cell == Cell::near_loop ? classify_by_library(uv) : cell == Cell::inside;
}

bool SheetInterior::classify_by_library(Vec2 uv) const {
  return _library.Perform(gp_Pnt2d(uv.x, uv.y)) != TopAbs_OUT;
}

}  // namespace aeroloom::cad
