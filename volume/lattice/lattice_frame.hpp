/// The grid of the interior points: cubic cells in grid units, and the affine map from the grid to space.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"

#include <array>
#include <numbers>

namespace aeroloom::volume {

/// Mean edge length of the Delaunay tetrahedra of a body-centred lattice, in edges of its cubic cell. Of the
/// 14 neighbours of a point, six are at a distance of 1 and eight at sqrt(3)/2.
inline constexpr double mean_edge_of_cell = (6.0 + 8.0 * 0.5 * std::numbers::sqrt3) / 14.0;

using geometry::GridCube;

/// A box in the grid. The unit is the edge of a finest cell.
struct GridBox {
  geometry::Vec3 low, high;

  static GridBox of(const GridCube& cell) {
    const double edge = cell.edge();
    const geometry::Vec3 low{double(cell.low.x), double(cell.low.y), double(cell.low.z)};
    return {low, low + geometry::Vec3{edge, edge, edge}};
  }
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
  /// The distance between two boxes; 0 where they touch or overlap.
  double gap_to(const GridBox& b) const {
    const auto along = [](double low_a, double high_a, double low_b, double high_b) {
      return std::max({low_b - high_a, low_a - high_b, 0.0});
    };
    return geometry::norm({along(low.x, high.x, b.low.x, b.high.x), along(low.y, high.y, b.low.y, b.high.y),
                           along(low.z, high.z, b.low.z, b.high.z)});
  }
};

/// The map between grid and space. It has a shear of a few per cent: the four corners of a square of the
/// lattice stay in one plane, but no longer lie on one circle. So the Delaunay mesh has no flat tetrahedra,
/// and the diagonals of parallel squares are the same. Immutable, the same on every rank.
class LatticeFrame {
public:
  /// The origin is the centre of the field's domain. The root cell covers `box`. The scale is chosen so that
  /// the most frequent sizes of the mesh match a level of the octree.
  LatticeFrame(const sizing::SizeField& field, const geometry::Box& box);

  geometry::Vec3 to_space(geometry::Vec3 grid) const { return _anchor + apply(_forward, grid - _middle); }
  geometry::Vec3 to_grid(geometry::Vec3 space) const { return _middle + apply(_backward, space - _anchor); }
  /// The finest cell that contains a point; for points outside the root, the nearest cell.
  sizing::GridPoint cell_at(geometry::Vec3 grid) const;
  /// The edge length in space of the cubic cells of a level, before the shear.
  double edge(int level) const { return _unit * (sizing::grid_size >> level); }
  /// The three edge vectors of a finest cell in space.
  std::array<geometry::Vec3, 3> steps() const {
    return {geometry::Vec3{_forward[0].x, _forward[1].x, _forward[2].x},
            {_forward[0].y, _forward[1].y, _forward[2].y},
            {_forward[0].z, _forward[1].z, _forward[2].z}};
  }
  /// An upper bound for the length in the grid of a distance in space.
  double grid_distance(double space) const { return space * _stretch; }
  /// The centre of a cube in space, and the bounding box of the cube in space.
  geometry::Vec3 middle_of(const GridCube& cube) const {
    const double half = 0.5 * cube.edge();
    return to_space(GridBox::of(cube).low + geometry::Vec3{half, half, half});
  }
  geometry::Box box_around(const GridCube& cube) const {
    const geometry::Vec3 middle = middle_of(cube), half = 0.5 * cube.edge() * _spread;
    return {middle - half, middle + half};
  }
  /// The bounding box in the grid of a box in space, and the other way round.
  GridBox grid_box(const geometry::Box& box) const;
  geometry::Box space_box(const GridBox& box) const;

private:
  using Matrix = std::array<geometry::Vec3, 3>;  // rows
  static geometry::Vec3 apply(const Matrix& m, geometry::Vec3 v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
  }

  geometry::Vec3 _anchor, _middle;
  double _unit = 1;  ///< edge length of a finest cell in space
  double _stretch = 1;
  geometry::Vec3 _spread;  ///< extent of a finest cell in space, along the axes
  Matrix _forward{}, _backward{};
};

}  // namespace aeroloom::volume
