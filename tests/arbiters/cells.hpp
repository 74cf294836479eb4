/// The cells of a mesh in a VTK file, their faces and shapes. Shares no code with the mesher.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace layercheck {

using Point = std::array<double, 3>;
using Index = std::int64_t;

constexpr int tetrahedron = 10, hexahedron = 12, prism = 13, pyramid = 14;

struct Cell {
  int type;
  int region;
  std::array<Index, 8> node;
};

/// Corners of a face in decreasing order; the last is -1 for a triangle.
using FaceKey = std::array<Index, 4>;

inline FaceKey in_order(FaceKey corners) {
  std::sort(corners.begin(), corners.end(), std::greater<>());
  return corners;
}

struct CellFace {
  FaceKey key;
  std::array<Index, 4> loop;  ///< counter-clockwise seen from outside the cell
  int corners;
  Index cell;
  int side;  ///< of the faces of its cell; triangles of a prism are 0 and 1
};

struct Mesh {
  std::vector<Point> points;  ///< in increasing order, each once
  std::size_t points_stored = 0;
  long orphans = 0;  ///< points of no cell
  std::vector<Cell> cells;
  std::map<int, long> other_types;  ///< numbers of cells left out, by type
};

inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator*(double s, const Point& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Point& a) {
  return std::sqrt(dot(a, a));
}
inline double volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  return dot(b - a, cross(c - a, d - a)) / 6;
}

/// Reads a .vtu or .pvtu without its ghost cells. Points that coincide in all coordinates are one.
Mesh read_mesh(const std::string& file);

int nodes_of(int type);

/// The faces of all cells, those with the same corners side by side.
std::vector<CellFace> all_faces(const Mesh& mesh);

/// Whether two faces with the same corners are seen from opposite sides.
bool opposite(const CellFace& a, const CellFace& b);

/// The smallest volume of the tetrahedra at the corners of a cell; of a prism, of all twelve into which it
/// can be cut.
double smallest_tetrahedron(const Mesh& mesh, const Cell& cell);

/// The integral of the Jacobian of the cell's shape functions: quadrilaterals are bilinear patches.
double volume_of(const Mesh& mesh, const Cell& cell);

/// Of a prism: 1 where it is right and stands on an equilateral triangle.
double scaled_jacobian(const Mesh& mesh, const Cell& cell);

}  // namespace layercheck
