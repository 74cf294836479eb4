#include "mesh/quality/cell_measures.hpp"

#include "geometry/angle.hpp"
#include "geometry/predicates.hpp"
#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>

namespace aeroloom::mesh {

using geometry::cross;
using geometry::dot;
using geometry::norm;
using geometry::Vec3;

namespace {

/// A corner with the three that edges lead to, right-handed.
struct Corner {
  int at;
  std::array<int, 3> next;
};
constexpr std::array<Corner, 4> pyramid_corners = {
    {{0, {1, 3, 4}}, {1, {2, 0, 4}}, {2, {3, 1, 4}}, {3, {0, 2, 4}}}};
constexpr std::array<Corner, 6> prism_corners = {
    {{0, {1, 2, 3}}, {1, {2, 0, 4}}, {2, {0, 1, 5}}, {3, {5, 4, 0}}, {4, {3, 5, 1}}, {5, {4, 3, 2}}}};
constexpr std::array<Corner, 8> hexahedron_corners = {{{0, {1, 3, 4}},
                                                       {1, {2, 0, 5}},
                                                       {2, {3, 1, 6}},
                                                       {3, {0, 2, 7}},
                                                       {4, {7, 5, 0}},
                                                       {5, {4, 6, 1}},
                                                       {6, {5, 7, 2}},
                                                       {7, {6, 4, 3}}}};

/// Of pyramids, prisms and hexahedra.
std::span<const Corner> corners_with_three_edges(CellShape shape) {
  if (shape == CellShape::hexahedron) return hexahedron_corners;
  if (shape == CellShape::prism) return prism_corners;
  return pyramid_corners;
}

/// The determinant of the unit vectors along the three edges at a corner, in a cell of equal edges.
double determinant_of_equal_edges(CellShape shape) {
  if (shape == CellShape::hexahedron) return 1;
  return shape == CellShape::prism ? std::numbers::sqrt3 / 2 : 1 / std::numbers::sqrt2;
}

using Edge = std::array<int, 2>;
constexpr std::array<Edge, 6> edges_of_tetrahedra = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
constexpr std::array<Edge, 8> edges_of_pyramids = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
constexpr std::array<Edge, 9> edges_of_prisms = {
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
constexpr std::array<Edge, 12> edges_of_hexahedra = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

std::span<const Edge> edges_of(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return edges_of_tetrahedra;
    case CellShape::pyramid:
      return edges_of_pyramids;
    case CellShape::prism:
      return edges_of_prisms;
    case CellShape::hexahedron:
      return edges_of_hexahedra;
  }
  throw std::logic_error("no such shape of a cell");
}

double determinant(Vec3 a, Vec3 b, Vec3 c) {
  return dot(cross(a, b), c);
}

/// The smallest and largest of some angles around edges, degrees, 0 to 360. Takes the inverse tangent of
/// those alone that may be one of them.
class AngleRange {
public:
  /// Around the edge `along` from `from` to `to`.
  void add(Vec3 along, Vec3 from, Vec3 to) {
    const double y = determinant(along, from, to) * norm(along),
                 x = dot(cross(along, from), cross(along, to));
    const double turn = x / (std::abs(x) + std::abs(y)), ascending = y < 0 ? 3 + turn : 1 - turn;
    const bool may_be_least = !(ascending > _least + rounding), may_be_most = !(ascending < _most - rounding);
    if (!may_be_least && !may_be_most) return;
    _least = std::min(_least, ascending), _most = std::max(_most, ascending);
    double angle = geometry::degrees_per_radian * std::atan2(y, x);
    if (angle < 0) angle += 360;
    _smallest = std::min(_smallest, angle), _largest = std::max(_largest, angle);
  }
  double smallest() const { return _smallest; }
  double largest() const { return _largest; }

private:
  static constexpr double rounding = 1e-12;
  double _least = 4, _most = 0;  // of what ascends with the angle, 0 to 4
  double _smallest = 360, _largest = 0;
};

/// Angles and Jacobians of pyramids, prisms and hexahedra. The edges from a pyramid's apex lie between
/// triangles, whose angle is the same at the other end.
void measure_corners(CellShape shape, const Vec3* p, CellValues& values) {
  const std::span<const Corner> corners = corners_with_three_edges(shape);
  AngleRange angles;
  double jacobian = std::numeric_limits<double>::infinity();
  for (const Corner& corner : corners) {
    std::array<Vec3, 3> edge;
    for (std::size_t k = 0; k < 3; ++k) edge[k] = p[corner.next[k]] - p[corner.at];
    for (std::size_t k = 0; k < 3; ++k) angles.add(edge[k], edge[(k + 1) % 3], edge[(k + 2) % 3]);
    const double lengths = norm(edge[0]) * norm(edge[1]) * norm(edge[2]);
    jacobian = std::min(jacobian, lengths > 0 ? determinant(edge[0], edge[1], edge[2]) / lengths : 0);
  }
  values[static_cast<std::size_t>(Measure::smallest_dihedral)] = angles.smallest();
  values[static_cast<std::size_t>(Measure::largest_dihedral)] = angles.largest();
  values[static_cast<std::size_t>(Measure::scaled_jacobian)] =
      std::min(1.0, jacobian / determinant_of_equal_edges(shape));
}

void measure_tetrahedron(const Vec3* p, CellValues& values) {
  const DihedralRange range = dihedral_range(p[0], p[1], p[2], p[3]);
  values[static_cast<std::size_t>(Measure::smallest_dihedral)] = range.smallest;
  values[static_cast<std::size_t>(Measure::largest_dihedral)] = range.largest;
  values[static_cast<std::size_t>(Measure::mean_ratio)] = mean_ratio(p[0], p[1], p[2], p[3]);
  values[static_cast<std::size_t>(Measure::radius_ratio)] = radius_ratio(p[0], p[1], p[2], p[3]);
}

double edge_ratio(CellShape shape, const Vec3* p) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (const Edge& edge : edges_of(shape)) {
    const Vec3 along = p[edge[1]] - p[edge[0]];
    const double squared = dot(along, along);
    shortest = std::min(shortest, squared), longest = std::max(longest, squared);
  }
  return shortest > 0 ? std::min(std::sqrt(longest / shortest), largest_ratio) : largest_ratio;
}

/// What is no number counts as the worst there is.
double without_nan(Measure measure, double value) {
  if (std::isfinite(value)) return value;
  if (measure == Measure::largest_dihedral) return 360;
  return larger_is_worse(measure) ? largest_ratio : 0;
}

}  // namespace

std::string_view name_of(Measure measure) {
  constexpr std::array<std::string_view, measure_count> names = {
      "min_dihedral_deg", "max_dihedral_deg", "mean_ratio",   "radius_ratio",
      "scaled_jacobian",  "edge_ratio",       "volume_ratio", "volume"};
  return names[static_cast<std::size_t>(measure)];
}

std::string_view name_of(CellShape shape) {
  constexpr std::array<std::string_view, cell_shape_count> names = {"tetrahedra", "pyramids", "prisms",
                                                                    "hexahedra"};
  return names[static_cast<std::size_t>(shape)];
}

double cell_volume(CellShape shape, const Vec3* p) {
  if (shape == CellShape::tetrahedron) return geometry::volume6(p[0], p[1], p[2], p[3]) / 6;
  double volume12 = 0;
  for (const CellFace& face : faces_of(shape)) {
    const Vec3 a = p[face[0]] - p[0], b = p[face[1]] - p[0], c = p[face[2]] - p[0];
    if (face[3] < 0) {
      volume12 += 2 * determinant(a, b, c);
    } else {
      volume12 += 2 * bilinear_cone_volume6(a, b, c, p[face[3]] - p[0]);
    }
  }
  return volume12 / 12;
}

double bilinear_cone_volume6(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return (determinant(a, b, c) + determinant(a, c, d) + determinant(a, b, d) + determinant(b, c, d)) / 2;
}

bool has_positive_corners(CellShape shape, const Vec3* p) {
  if (shape == CellShape::tetrahedron) return geometry::has_positive_volume(p[0], p[1], p[2], p[3]);
  const std::span<const Corner> corners = corners_with_three_edges(shape);
  return std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
    return geometry::has_positive_volume(p[corner.at], p[corner.next[0]], p[corner.next[1]],
                                         p[corner.next[2]]);
  });
}

CellValues measure_cell(CellShape shape, const Vec3* corners) {
  CellValues values{};
  if (shape == CellShape::tetrahedron) {
    measure_tetrahedron(corners, values);
  } else {
    measure_corners(shape, corners, values);
  }
  values[static_cast<std::size_t>(Measure::edge_ratio)] = edge_ratio(shape, corners);
  values[static_cast<std::size_t>(Measure::volume)] = cell_volume(shape, corners);
  for (const Measure measure : all_measures) {
    double& value = values[static_cast<std::size_t>(measure)];
    value = without_nan(measure, value);
  }
  return values;
}

double volume_ratio(double a, double b) {
  const double smaller = std::min(a, b), larger = std::max(a, b);
  return smaller > 0 && std::isfinite(larger) ? std::min(larger / smaller, largest_ratio) : largest_ratio;
}

double face_area(FaceShape shape, const Vec3* p) {
  const auto twice = [](Vec3 a, Vec3 b, Vec3 c) { return norm(cross(b - a, c - a)); };
  if (shape == FaceShape::triangle) return twice(p[0], p[1], p[2]) / 2;
  return (twice(p[0], p[1], p[2]) + twice(p[0], p[2], p[3]) + twice(p[0], p[1], p[3]) +
          twice(p[1], p[2], p[3])) /
         4;
}

}  // namespace aeroloom::mesh
