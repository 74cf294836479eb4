/// One background triangle of an interface, meshed under the size field.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace aeroloom::surface {

/// A side of the triangle, from corner k to corner k + 1, both included.
struct PatchSide {
  std::vector<geometry::Vec3> points;
  bool straight = true;  ///< else the points lie on a curve of the surface
};

struct PatchMesh {
  std::vector<geometry::Vec3> inner;  ///< points inside
  /// Counter-clockwise like the corners. Vertices: the points of side 0 but its last, of side 1, of side 2,
  /// then the inner ones.
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Fills the triangle by the front kernel. Where a side is a curve, the patch blends from it to the plane of
/// the corners (Gordon and Hall, Int. J. Numer. Methods Eng. 7, 1973, doi:10.1002/nme.1620070405). `size` is
/// the edge length wanted at a point of space. A function of its arguments alone. Throws FrontError.
PatchMesh fill_triangle(const std::array<PatchSide, 3>& sides,
                        const std::function<double(geometry::Vec3)>& size);

}  // namespace aeroloom::surface
