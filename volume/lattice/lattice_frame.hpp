/// The grid that the interior points stand on: cubic cells in grid units, seen in space through one affine
/// map.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace aeroloom::volume {

/// Mean edge length of the Delaunay tetrahedra of a body-centred lattice, in edges of its cubic cell: of
/// fourteen neighbours six are 1 and eight are sqrt(3)/2 away.
inline constexpr double mean_edge_of_cell = (6.0 + 8.0 * 0.5 * std::numbers::sqrt3) / 14.0;

using geometry::GridCube;

/// A box of the grid, in units of the finest cells.
struct GridBox {
  geometry::Vec3 low, high;

  static GridBox of(const GridCube& cell) {
    const double edge = cell.edge();
    const geometry::Vec3 low{double(cell.low.x), double(cell.low.y), double(cell.low.z)};
    return {low, low + geometry::Vec3{edge, edge, edge}};
  }
  static constexpr auto fields() { return std::tuple(&GridBox::low, &GridBox::high); }
  GridBox dilated(double by) const {
    return {low - geometry::Vec3{by, by, by}, high + geometry::Vec3{by, by, by}};
  }
  geometry::Vec3 corner(int which) const {
    return {(which & 1 ? high : low).x, (which & 2 ? high : low).y, (which & 4 ? high : low).z};
  }
  bool overlaps(const GridBox& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  /// The distance between two boxes; 0 where they touch.
  double gap_to(const GridBox& b) const {
    const auto along = [](double low_a, double high_a, double low_b, double high_b) {
      return std::max({low_b - high_a, low_a - high_b, 0.0});
    };
    return geometry::norm({along(low.x, high.x, b.low.x, b.high.x), along(low.y, high.y, b.low.y, b.high.y),
                           along(low.z, high.z, b.low.z, b.high.z)});
  }
};

/// Grid and space. A shear of a few per cent takes the four points of every square of the lattice off one
/// circle, but leaves them in one plane: so the Delaunay mesh has no flat tetrahedra and picks the diagonals
/// of its squares everywhere alike. Immutable, the same on every rank.
class LatticeFrame {
public:
  /// Anchored at the centre of the field's domain; the root cell covers `box`. The scale is such that the
  /// sizes most of the mesh will have are those of a level.
  LatticeFrame(const sizing::SizeField& field, const geometry::Box& box);

  geometry::Vec3 to_space(geometry::Vec3 grid) const { return _anchor + apply(_forward, grid - _middle); }
  geometry::Vec3 to_grid(geometry::Vec3 space) const { return _middle + apply(_backward, space - _anchor); }
  /// The finest cell that holds a point; the nearest one for points outside of the root.
  sizing::GridPoint cell_at(geometry::Vec3 grid) const;
  /// Edge of the cubic cells of a level, in space and before the shear.
  double edge(int level) const { return _unit * (sizing::grid_size >> level); }
  /// The three edges of a finest cell in space.
  std::array<geometry::Vec3, 3> steps() const {
    return {geometry::Vec3{_forward[0].x, _forward[1].x, _forward[2].x},
            {_forward[0].y, _forward[1].y, _forward[2].y},
            {_forward[0].z, _forward[1].z, _forward[2].z}};
  }
  /// The length in the grid of a distance in space, at most.
  double grid_distance(double space) const { return space * _stretch; }
  /// The middle of a cube, and the box in space around it.
  geometry::Vec3 middle_of(const GridCube& cube) const {
    const double half = 0.5 * cube.edge();
    return to_space(GridBox::of(cube).low + geometry::Vec3{half, half, half});
  }
  geometry::Box box_around(const GridCube& cube) const {
    const geometry::Vec3 middle = middle_of(cube), half = 0.5 * cube.edge() * _spread;
    return {middle - half, middle + half};
  }
  /// The box in the grid that holds a box of space.
  GridBox grid_box(const geometry::Box& box) const;

private:
  using Matrix = std::array<geometry::Vec3, 3>;  // rows
  static geometry::Vec3 apply(const Matrix& m, geometry::Vec3 v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
  }

  geometry::Vec3 _anchor, _middle;
  double _unit = 1;  ///< edge of a finest cell in space
  double _stretch = 1;
  geometry::Vec3 _spread;  ///< of a finest cell in space, along the axes
  Matrix _forward{}, _backward{};
};

}  // namespace aeroloom::volume
