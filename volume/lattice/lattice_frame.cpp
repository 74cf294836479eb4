#include "volume/lattice/lattice_frame.hpp"

#include <algorithm>

namespace aeroloom::volume {

using geometry::Box;
using geometry::Vec3;

namespace {

/// The size of the shear, and its matrix: any numbers without symmetry would do.
constexpr double shear = 0.03;
constexpr Vec3 mixing[3] = {{0, 0.6, 0.35}, {0.45, 0, -0.5}, {0.4, -0.3, 0}};
/// The number of samples of the field from which the scale is chosen. Chosen, not measured.
constexpr std::int64_t scale_samples = 4096;
/// The width of the root over that of the domain. Chosen, not measured.
constexpr double root_margin = 1.02;

/// The size of the coarsest level: the maximum of the field, or up to half an octave off. Levels then match
/// the most frequent sizes of the mesh (circular mean of log2 h, weighted by predicted tetrahedra).
double reference_size(const sizing::SizeField& field) {
  const std::int64_t leaves = field.leaf_count();
  const std::int64_t stride = std::max<std::int64_t>(1, leaves / scale_samples);
  double cosine = 0, sine = 0;
  for (std::int64_t i = 0; i < leaves; i += stride) {
    const auto leaf = field.leaf(i);
    const double weight = std::pow(leaf.edge / leaf.size, 3);
    const double angle = 2 * std::numbers::pi * std::log2(leaf.size / field.maximum());
    cosine += weight * std::cos(angle);
    sine += weight * std::sin(angle);
  }
  return field.maximum() * std::exp2(std::atan2(sine, cosine) / (2 * std::numbers::pi));
}

}  // namespace

LatticeFrame::LatticeFrame(const sizing::SizeField& field, const Box& box)
    : _anchor(field.domain().center()) {
  Matrix sheared;
  for (int row = 0; row < 3; ++row) {
    sheared[row] = shear * mixing[row];
    sheared[row][row] += 1;
  }
  const auto& [a, b, c] = sheared;
  const double determinant = dot(a, cross(b, c));
  const Vec3 columns[3] = {cross(b, c) / determinant, cross(c, a) / determinant, cross(a, b) / determinant};
  Matrix inverse;
  double squares = 0;
  for (int row = 0; row < 3; ++row) {
    inverse[row] = {columns[0][row], columns[1][row], columns[2][row]};
    Vec3 change = inverse[row];
    change[row] -= 1;
    squares += dot(change, change);
  }

  double extent = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 g = apply(inverse, GridBox{box.low, box.high}.corner(corner) - _anchor);
    extent = std::max({extent, std::abs(g.x), std::abs(g.y), std::abs(g.z)});
  }
  double root_edge = reference_size(field) / mean_edge_of_cell;
  while (root_edge > 4 * root_margin * extent) root_edge *= 0.5;
  while (root_edge < 2 * root_margin * extent) root_edge *= 2;
  _unit = root_edge / sizing::grid_size;
  const double half = 0.5 * sizing::grid_size;
  _middle = {half, half, half};
  for (int row = 0; row < 3; ++row) {
    _forward[row] = _unit * sheared[row];
    _backward[row] = inverse[row] / _unit;
    _spread[row] = std::abs(_forward[row].x) + std::abs(_forward[row].y) + std::abs(_forward[row].z);
  }
  _stretch = (1 + std::sqrt(squares)) / _unit;
}

sizing::GridPoint LatticeFrame::cell_at(Vec3 grid) const {
  const auto along = [](double t) {
    return !(t > 0)                      ? 0U
           : t < sizing::grid_size - 1.0 ? static_cast<std::uint32_t>(t)
                                         : sizing::grid_size - 1;
  };
  return {along(grid.x), along(grid.y), along(grid.z)};
}

GridBox LatticeFrame::grid_box(const Box& box) const {
  Box image;
  for (int corner = 0; corner < 8; ++corner) image.add(to_grid(GridBox{box.low, box.high}.corner(corner)));
  return {image.low, image.high};
}

Box LatticeFrame::space_box(const GridBox& box) const {
  Box image;
  for (int corner = 0; corner < 8; ++corner) image.add(to_space(box.corner(corner)));
  return image;
}

}  // namespace aeroloom::volume
