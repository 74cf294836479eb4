#include "io/vtk/cell_quality.hpp"

#include "mesh/quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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

/// Two faces of a shape that share an edge.
struct Neighbours {
  int a, b;
};

std::vector<Neighbours> find_neighbours(CellShape shape) {
  const std::span<const CellFace> faces = faces_of(shape);
  std::vector<Neighbours> found;
  for (int a = 0; a < static_cast<int>(faces.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(faces.size()); ++b) {
      const auto common = std::count_if(faces[a].begin(), faces[a].end(), [&](std::int8_t v) {
        return v >= 0 && std::find(faces[b].begin(), faces[b].end(), v) != faces[b].end();
      });
      if (common == 2) found.push_back({a, b});
    }
  }
  return found;
}

const std::vector<Neighbours>& neighbours_of(CellShape shape) {
  static const std::array<std::vector<Neighbours>, cell_shape_count> tables = {
      find_neighbours(cell_shapes[0]), find_neighbours(cell_shapes[1]), find_neighbours(cell_shapes[2])};
  return tables[static_cast<std::size_t>(shape)];
}

Vec3 area_vector(const CellFace& face, std::span<const Vec3> p) {
  if (face[3] < 0) return cross(p[face[1]] - p[face[0]], p[face[2]] - p[face[0]]);
  return cross(p[face[2]] - p[face[0]], p[face[3]] - p[face[1]]);
}

}  // namespace

double mean_ratio(CellShape shape, std::span<const Vec3> corners) {
  switch (shape) {
    case CellShape::pyramid:
      return pyramid_ratio(corners);
    case CellShape::prism:
      return prism_ratio(corners);
    default:
      return mesh::mean_ratio(corners[0], corners[1], corners[2], corners[3]);
  }
}

double smallest_dihedral(CellShape shape, std::span<const Vec3> corners) {
  if (shape == CellShape::tetrahedron)
    return mesh::dihedral_range(corners[0], corners[1], corners[2], corners[3]).smallest;
  const std::span<const CellFace> faces = faces_of(shape);
  std::array<Vec3, 5> normals;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    normals[f] = area_vector(faces[f], corners);
    const double length = std::sqrt(dot(normals[f], normals[f]));
    if (length == 0) return 0;
    normals[f] = (1 / length) * normals[f];
  }
  double largest_cosine = -1;  // of the angle between faces: outward normals differ by what is left to 180
  for (const auto& [a, b] : neighbours_of(shape))
    largest_cosine = std::max(largest_cosine, -dot(normals[a], normals[b]));
  return std::acos(std::min(largest_cosine, 1.0)) * 180 / std::numbers::pi;
}

}  // namespace aeroloom::io
