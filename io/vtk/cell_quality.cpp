#include "io/vtk/cell_quality.hpp"

#include "mesh/quality/cell_measures.hpp"
#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::io {

namespace {

using geometry::Vec3;

/// Of three edges where those of the regular corner are axes.
double corner_shape(Vec3 x, Vec3 y, Vec3 z) {
  const double volume = dot(cross(x, y), z), squares = dot(x, x) + dot(y, y) + dot(z, z);
  return squares > 0 ? std::copysign(3 * std::cbrt(volume * volume) / squares, volume) : 0;
}

double pyramid_ratio(std::span<const Vec3> p) {
  double smallest = 1;
  for (int i = 0; i < 4; ++i) {
    const Vec3 x = p[(i + 1) % 4] - p[i], y = p[(i + 3) % 4] - p[i], up = p[4] - p[i];
    smallest = std::min(smallest, corner_shape(x, y, std::numbers::sqrt2 * (up - 0.5 * (x + y))));
  }
  return smallest;
}

double prism_ratio(std::span<const Vec3> p) {
  double smallest = 1;
  for (int i = 0; i < 6; ++i) {
    const bool upper = i >= 3;
    const int base = upper ? 3 : 0, next = base + (i + 1) % 3, last = base + (i + 2) % 3;
    const Vec3 x = p[upper ? last : next] - p[i], y = p[upper ? next : last] - p[i],
               z = p[(i + 3) % 6] - p[i];
    smallest = std::min(smallest, corner_shape(x, 2 * std::numbers::inv_sqrt3 * (y - 0.5 * x), z));
  }
  return smallest;
}

double hexahedron_ratio(std::span<const Vec3> p) {
  double smallest = 1;
  for (int i = 0; i < 8; ++i) {
    const bool upper = i >= 4;
    const int base = upper ? 4 : 0, next = base + (i + 1) % 4, last = base + (i + 3) % 4;
    smallest = std::min(smallest, corner_shape(p[upper ? last : next] - p[i], p[upper ? next : last] - p[i],
                                               p[(i + 4) % 8] - p[i]));
  }
  return smallest;
}

}  // namespace

double mean_ratio(CellShape shape, std::span<const Vec3> corners) {
  switch (shape) {
    case CellShape::pyramid:
      return pyramid_ratio(corners);
    case CellShape::prism:
      return prism_ratio(corners);
    case CellShape::hexahedron:
      return hexahedron_ratio(corners);
    default:
      return mesh::mean_ratio(corners[0], corners[1], corners[2], corners[3]);
  }
}

double smallest_dihedral(CellShape shape, std::span<const Vec3> corners) {
  if (shape == CellShape::tetrahedron)
    return mesh::dihedral_range(corners[0], corners[1], corners[2], corners[3]).smallest;
  return mesh::measure_cell(shape,
                            corners.data())[static_cast<std::size_t>(mesh::Measure::smallest_dihedral)];
}

}  // namespace aeroloom::io
