#include "surface/charts/conformal_map.hpp"

#include "surface/charts/surface_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;
using Matrix = Eigen::SparseMatrix<double>;
using Solver = Eigen::SimplicialLDLT<Matrix>;
using Entry = Eigen::Triplet<double>;

/// Cotangents of flatter angles are cut off: slivers must not rule the system.
constexpr double largest_cotangent = 1e5;
constexpr double least_across = 1e-300;  // in place of a length of nothing, to divide by
/// Keeps the systems regular: translations (and, on developable patches, similarities) cost nothing.
constexpr double regularisation = 1e-9;
/// Each brings the eigenvector nearer by the ratio of the two smallest eigenvalues; chosen, not measured.
constexpr int inverse_iterations = 12;

/// Half the cotangents of a triangle's angles, by corner.
std::array<double, 3> half_cotangents(const ChartSurface& surface,
                                      const std::array<std::int32_t, 3>& triangle) {
  std::array<double, 3> result;
  for (int i = 0; i < 3; ++i) {
    const Vec3 apex = surface.points[triangle[i]];
    const Vec3 a = surface.points[triangle[(i + 1) % 3]] - apex,
               b = surface.points[triangle[(i + 2) % 3]] - apex;
    const double along = dot(a, b), across = norm(cross(a, b));
    const double limit = largest_cotangent * across;
    result[i] = 0.5 * (std::abs(along) <= limit ? along / std::max(across, least_across)
                                                : std::copysign(largest_cotangent, along));
  }
  return result;
}

/// Adds the cotangent Laplacian with its first row and column at `offset`.
void add_laplacian(const ChartSurface& surface, int offset, std::vector<Entry>& entries) {
  for (const auto& triangle : surface.triangles) {
    const auto weights = half_cotangents(surface, triangle);
    for (int i = 0; i < 3; ++i) {
      const int a = offset + triangle[(i + 1) % 3], b = offset + triangle[(i + 2) % 3];
      entries.emplace_back(a, a, weights[i]);
      entries.emplace_back(b, b, weights[i]);
      entries.emplace_back(a, b, -weights[i]);
      entries.emplace_back(b, a, -weights[i]);
    }
  }
}

Matrix assemble(int size, std::vector<Entry>& entries) {
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, regularisation);
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Twice the conformal energy of (u, v): Dirichlet's minus the area enclosed by the image of the boundary.
Matrix conformal_energy(const ChartSurface& surface, const std::vector<geometry::HalfEdge>& boundary) {
  const int n = static_cast<int>(surface.points.size());
  std::vector<Entry> entries;
  add_laplacian(surface, 0, entries);
  add_laplacian(surface, n, entries);
  for (const geometry::HalfEdge h : boundary) {
    const int i = start_of(surface, h), j = end_of(surface, h);
    entries.emplace_back(i, n + j, -0.5);
    entries.emplace_back(n + j, i, -0.5);
    entries.emplace_back(j, n + i, 0.5);
    entries.emplace_back(n + i, j, 0.5);
  }
  return assemble(2 * n, entries);
}

double plane_area(const ChartSurface& surface, const PlaneMap& map) {
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) area += 0.5 * cross(map[b] - map[a], map[c] - map[a]);
  return area;
}

/// Gives the map the area of the chart surface; nothing where it has none.
std::optional<PlaneMap> normalise_area(const ChartSurface& surface, PlaneMap map) {
  const double area = plane_area(surface, map);
  if (!(area > 0) || !std::isfinite(area)) return std::nullopt;
  const double factor = std::sqrt(surface_area(surface) / area);
  for (Vec2& p : map) p *= factor;
  return map;
}

/// A triangle laid into the plane: first corner at the origin, second on the positive x axis.
std::array<Vec2, 3> lay_flat(const ChartSurface& surface, const std::array<std::int32_t, 3>& triangle) {
  const Vec3 a = surface.points[triangle[0]];
  const Vec3 ab = surface.points[triangle[1]] - a, ac = surface.points[triangle[2]] - a;
  const double length = norm(ab);
  if (!(length > 0)) return {Vec2{}, Vec2{}, Vec2{norm(ac), 0}};
  return {Vec2{}, Vec2{length, 0}, Vec2{dot(ab, ac) / length, norm(cross(ab, ac)) / length}};
}

}  // namespace

PlaneMap project_to_mean_plane(const ChartSurface& surface) {
  Vec3 normal;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    normal += area_vector(surface, static_cast<std::int32_t>(t));
  normal = normalized(normal);
  if (norm(normal) == 0) normal = {0, 0, 1};
  int least = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(normal[axis]) < std::abs(normal[least])) least = axis;
  }
  Vec3 axis;
  axis[least] = 1;
  const Vec3 first = normalized(cross(axis, normal)), second = cross(normal, first);
  const Vec3 origin = surface.points.front();
  PlaneMap map;
  map.reserve(surface.points.size());
  for (const Vec3 p : surface.points) map.push_back({dot(p - origin, first), dot(p - origin, second)});
  return map;
}

std::optional<PlaneMap> map_conformally(const ChartSurface& surface, const PlaneMap& start) {
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(surface.triangles);
  std::vector<geometry::HalfEdge> boundary;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    if (twins[h] < 0) boundary.push_back(h);
  }
  const int n = static_cast<int>(surface.points.size());
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
  for (const geometry::HalfEdge h : boundary) {
    const double half =
        0.5 * distance(surface.points[start_of(surface, h)], surface.points[end_of(surface, h)]);
    weight[start_of(surface, h)] += half;
    weight[end_of(surface, h)] += half;
  }
  const double total = weight.sum();
  if (!(total > 0)) return std::nullopt;
  const Solver solver(conformal_energy(surface, boundary));
  if (solver.info() != Eigen::Success) return std::nullopt;

  Eigen::VectorXd x(2 * n);
  for (int i = 0; i < n; ++i) x[i] = start[i].x, x[n + i] = start[i].y;
  for (int step = 0; step < inverse_iterations; ++step) {
    double size = 0;
    for (const int offset : {0, n}) {
      auto part = x.segment(offset, n);
      part.array() -= part.dot(weight) / total;
      size += (part.array().square() * weight.array()).sum();
    }
    if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
    x /= std::sqrt(size / total);
    Eigen::VectorXd right(2 * n);
    right << weight.cwiseProduct(x.head(n)), weight.cwiseProduct(x.tail(n));
    x = solver.solve(right);
  }
  PlaneMap map(n);
  for (int i = 0; i < n; ++i) map[i] = {x[i], x[n + i]};
  return normalise_area(surface, std::move(map));
}

std::optional<PlaneMap> map_rigidly(const ChartSurface& surface, const PlaneMap& start, int steps) {
  const int n = static_cast<int>(surface.points.size());
  std::vector<Entry> entries;
  add_laplacian(surface, 0, entries);
  const Solver solver(assemble(n, entries));
  if (solver.info() != Eigen::Success) return std::nullopt;
  PlaneMap map = start;
  for (int step = 0; step < steps; ++step) {
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
    for (const auto& triangle : surface.triangles) {
      const auto flat = lay_flat(surface, triangle);
      const auto weights = half_cotangents(surface, triangle);
      // The rotation nearest to the map's Jacobian on this triangle.
      double c = 0, s = 0;
      for (int i = 0; i < 3; ++i) {
        const Vec2 here = flat[(i + 2) % 3] - flat[(i + 1) % 3];
        const Vec2 there = map[triangle[(i + 2) % 3]] - map[triangle[(i + 1) % 3]];
        c += weights[i] * dot(here, there);
        s += weights[i] * cross(here, there);
      }
      const double size = std::hypot(c, s);
      if (!(size > 0)) continue;
      c /= size, s /= size;
      for (int i = 0; i < 3; ++i) {
        const int a = triangle[(i + 1) % 3], b = triangle[(i + 2) % 3];
        const Vec2 here = weights[i] * (flat[(i + 2) % 3] - flat[(i + 1) % 3]);
        const Eigen::RowVector2d rotated(c * here.x - s * here.y, s * here.x + c * here.y);
        right.row(b) += rotated;
        right.row(a) -= rotated;
      }
    }
    const Eigen::MatrixX2d solution = solver.solve(right);
    for (int i = 0; i < n; ++i) map[i] = {solution(i, 0), solution(i, 1)};
  }
  return normalise_area(surface, std::move(map));
}

std::optional<PlaneMap> scale_parameters(const ChartSurface& surface) {
  PlaneMap map(surface.points.size());
  std::vector<char> known(surface.points.size(), 0);
  double along_u = 0, along_v = 0, area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& triangle = surface.triangles[t];
    for (int i = 0; i < 3; ++i) {
      const Vec2 uv = surface.corner_uv[t][i];
      if (known[triangle[i]] && !(map[triangle[i]] == uv)) return std::nullopt;
      map[triangle[i]] = uv, known[triangle[i]] = 1;
    }
    // Mean squared lengths of the surface's derivatives over the triangle, from its gradients.
    const Vec3 e1 = surface.points[triangle[1]] - surface.points[triangle[0]];
    const Vec3 e2 = surface.points[triangle[2]] - surface.points[triangle[0]];
    const Vec2 d1 = surface.corner_uv[t][1] - surface.corner_uv[t][0];
    const Vec2 d2 = surface.corner_uv[t][2] - surface.corner_uv[t][0];
    const double determinant = cross(d1, d2);
    if (determinant == 0) continue;
    const double weight = 0.5 * norm(cross(e1, e2));
    along_u += weight * norm((d2.y * e1 - d1.y * e2) / determinant);
    along_v += weight * norm((d1.x * e2 - d2.x * e1) / determinant);
    area += weight;
  }
  if (!(area > 0)) return std::nullopt;
  for (Vec2& p : map) p = {p.x * along_u / area, p.y * along_v / area};
  if (plane_area(surface, map) < 0) {
    for (Vec2& p : map) p.x = -p.x;
  }
  return normalise_area(surface, std::move(map));
}

std::vector<double> point_scales(const ChartSurface& surface, const PlaneMap& map) {
  std::vector<double> chart(surface.points.size(), 0), space(surface.points.size(), 0);
  double chart_total = 0, space_total = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const double chart_area = std::max(0.0, 0.5 * cross(map[b] - map[a], map[c] - map[a]));
    const double space_area = norm(area_vector(surface, static_cast<std::int32_t>(t)));
    chart_total += chart_area, space_total += space_area;
    for (const std::int32_t p : {a, b, c}) chart[p] += chart_area, space[p] += space_area;
  }
  const double mean = std::sqrt(chart_total / space_total);
  std::vector<double> scales(surface.points.size(), mean);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (space[i] > 0 && chart[i] > 0) scales[i] = std::sqrt(chart[i] / space[i]);
  }
  return scales;
}

}  // namespace aeroloom::surface
