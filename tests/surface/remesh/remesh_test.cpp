#include "surface/remesh/remesh.hpp"

#include "mesh/quality/quality.hpp"
#include "surface/remesh/face_remesher.hpp"
#include "tests/cad/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using cad::PrimitiveKind;
using geometry::Vec2;
using geometry::Vec3;

constexpr double pi = std::numbers::pi;

sizing::SizeField uniform_field(const Model& model, double size) {
  return sizing::SizeField::build(model.bounds(), {}, {.minimum = size, .maximum = size});
}

/// A grid of the face's parameters, periodic where asked for; `start` is a guess for the projections.
struct Grid {
  int columns, rows;
  bool periodic_u, periodic_v;
};

/// Turns triangles so that they agree with the face's outward normal.
void orient(const Model& model, FaceMesh& mesh) {
  for (auto& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    const auto at = model.project(mesh.face, (a + b + c) / 3.0, mesh.uv[t[0]]);
    if (dot(cross(b - a, c - a), model.face_frame(mesh.face, at.uv).normal) < 0) std::swap(t[1], t[2]);
  }
}

FaceMesh grid_mesh(const Model& model, cad::FaceId face, const Grid& grid,
                   const std::function<Vec3(double, double)>& place, Vec2 guess) {
  FaceMesh mesh;
  mesh.face = face;
  const int columns = grid.columns + (grid.periodic_u ? 0 : 1), rows = grid.rows + (grid.periodic_v ? 0 : 1);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto at = model.project(face, place(double(i) / grid.columns, double(j) / grid.rows), guess);
      EXPECT_TRUE(at.converged);
      mesh.points.push_back(at.point);
      mesh.uv.push_back(at.uv);
      guess = at.uv;
    }
  }
  const auto vertex = [&](int i, int j) { return (j % rows) * columns + i % columns; };
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  orient(model, mesh);
  return mesh;
}

/// Moves the free vertices about by a share of the size.
void shake(const Model& model, double distance, FaceMesh& mesh) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-distance, distance);
  for (std::size_t v = mesh.fixed; v < mesh.points.size(); ++v) {
    const Vec3 target = mesh.points[v] + Vec3{unit(random), unit(random), unit(random)};
    const auto at = model.project(mesh.face, target, mesh.uv[v]);
    mesh.points[v] = at.point;
    mesh.uv[v] = at.uv;
  }
}

struct Measure {
  double worst = 1, mean = 0, smallest_angle = 180, area = 0, facing = 1;
  int euler = 0, border_edges = 0;
};

/// Checks that the triangles form a consistently oriented manifold without orphans, on the surface.
Measure measure(const Model& model, const FaceMesh& mesh) {
  Measure m;
  std::map<std::array<std::int32_t, 2>, int> sides;
  std::vector<int> used(mesh.points.size(), 0);
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    const double q = mesh::triangle_mean_ratio(a, b, c);
    m.worst = std::min(m.worst, q);
    m.mean += q / static_cast<double>(mesh.triangles.size());
    m.smallest_angle = std::min(m.smallest_angle, mesh::smallest_angle(a, b, c));
    m.area += norm(cross(b - a, c - a)) / 2;
    const auto at = model.project(mesh.face, (a + b + c) / 3.0, mesh.uv[t[0]]);
    m.facing =
        std::min(m.facing, dot(normalized(cross(b - a, c - a)), model.face_frame(mesh.face, at.uv).normal));
    for (int i = 0; i < 3; ++i) {
      used[t[i]] = 1;
      EXPECT_EQ(++sides[(std::array{t[i], t[(i + 1) % 3]})], 1);
    }
  }
  int interior = 0;
  for (const auto& [side, count] : sides) interior += sides.contains({side[1], side[0]});
  m.border_edges = static_cast<int>(sides.size()) - interior;
  m.euler = std::count(used.begin(), used.end(), 1) - (interior / 2 + m.border_edges) +
            static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    EXPECT_LT(distance(model.face_point(mesh.face, mesh.uv[v]), mesh.points[v]), 1e-9);
  }
  return m;
}

void expect_good(const Model& model, const FaceMesh& before, const FaceMesh& after, double size) {
  const Measure first = measure(model, before), last = measure(model, after);
  EXPECT_EQ(last.euler, first.euler);
  EXPECT_EQ(last.border_edges, first.border_edges);
  EXPECT_GE(last.worst, std::min(0.65, first.worst));
  EXPECT_GT(last.facing, 0.7);
  EXPECT_GE(last.mean, 0.95);
  EXPECT_GE(last.smallest_angle, 25);
  EXPECT_NEAR(last.area, first.area, 0.02 * first.area);
  const double expected = last.area * 4 / (std::numbers::sqrt3 * size * size);
  EXPECT_NEAR(static_cast<double>(after.triangles.size()), expected, 0.2 * expected);
  for (std::int32_t v = 0; v < before.fixed; ++v) {
    EXPECT_EQ(after.points[v], before.points[v]);
    EXPECT_EQ(after.uv[v], before.uv[v]);
  }
}

/// The face of a primitive whose facets reach furthest from the box's planes: the only curved one.
cad::FaceId curved_face(const Model& model) {
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (!model.is_planar(f)) return f;
  }
  return cad::no_entity;
}

FaceMesh torus_mesh(const Model& model, double size) {
  const double major = 0.5, minor = 0.25;
  const Grid grid{static_cast<int>(2 * pi * major / size), static_cast<int>(2 * pi * minor / size), true,
                  true};
  const auto place = [&](double s, double t) {
    const double a = 2 * pi * s, b = 2 * pi * t, r = major + minor * std::cos(b);
    return Vec3{r * std::cos(a), r * std::sin(a), minor * std::sin(b)};
  };
  return grid_mesh(model, 0, grid, place, {});
}

TEST(Remesh, ImprovesATorusAcrossItsSeams) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::torus);
  const double size = 0.04;
  FaceMesh mesh = torus_mesh(model, size);
  shake(model, 0.2 * size, mesh);
  const FaceMesh before = mesh;
  remesh_interior(model, uniform_field(model, size), {.sweeps = 6}, mesh);
  expect_good(model, before, mesh, size);
}

TEST(Remesh, ImprovesASphereAcrossItsPoles) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::sphere);
  const double size = 0.02;
  // An octahedron, each side divided n times and blown up.
  FaceMesh mesh;
  mesh.face = 0;
  const int n = 20;
  std::map<std::array<int, 3>, std::int32_t> number;
  const auto vertex = [&](int x, int y, int z) {
    const auto [place, is_new] = number.try_emplace({x, y, z}, static_cast<std::int32_t>(mesh.points.size()));
    if (is_new) {
      const auto at =
          model.project(0, 0.25 * normalized(Vec3{double(x), double(y), double(z)}), Vec2{0.1, 0.1});
      mesh.points.push_back(at.point);
      mesh.uv.push_back(at.uv);
    }
    return place->second;
  };
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      for (const int sz : {-1, 1}) {
        const auto at = [&](int i, int j) { return vertex(sx * i, sy * j, sz * (n - i - j)); };
        for (int i = 0; i < n; ++i) {
          for (int j = 0; i + j < n; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 1 < n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
          }
        }
      }
    }
  }
  orient(model, mesh);
  shake(model, 0.2 * size, mesh);
  const FaceMesh before = mesh;
  remesh_interior(model, uniform_field(model, size), {.sweeps = 6}, mesh);
  expect_good(model, before, mesh, size);
}

/// The side of a cylinder from rim to rim, closed across the seam, the rims fixed.
FaceMesh cylinder_mesh(const Model& model, double size, double row_factor) {
  const double radius = 0.25;
  const Grid grid{static_cast<int>(2 * pi * radius / size), static_cast<int>(row_factor / size), true, false};
  const auto place = [&](double s, double t) {
    return Vec3{radius * std::cos(2 * pi * s), radius * std::sin(2 * pi * s), t - 0.5};
  };
  FaceMesh mesh = grid_mesh(model, curved_face(model), grid, place, {});
  // Rim vertices first.
  const auto count = static_cast<std::int32_t>(mesh.points.size());
  const auto is_rim = [&](std::int32_t v) { return v < grid.columns || v >= count - grid.columns; };
  std::vector<std::int32_t> order(count), number(count);
  for (std::int32_t v = 0; v < count; ++v) order[v] = v;
  std::stable_partition(order.begin(), order.end(), is_rim);
  const FaceMesh old = mesh;
  for (std::int32_t k = 0; k < count; ++k) {
    number[order[k]] = k;
    mesh.points[k] = old.points[order[k]];
    mesh.uv[k] = old.uv[order[k]];
  }
  for (auto& t : mesh.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  mesh.fixed = 2 * grid.columns;
  return mesh;
}

class CylinderRows : public testing::TestWithParam<double> {};

TEST_P(CylinderRows, ReachTheWantedSize) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::cylinder);
  const double size = 0.04;
  FaceMesh mesh = cylinder_mesh(model, size, GetParam());
  shake(model, 0.1 * size, mesh);
  const FaceMesh before = mesh;
  remesh_interior(model, uniform_field(model, size), {.sweeps = 8}, mesh);
  expect_good(model, before, mesh, size);
}

INSTANTIATE_TEST_SUITE_P(CoarseToFine, CylinderRows, testing::Values(0.6, 1.0, 2.5));

TEST(Remesh, FollowsAGradedField) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::torus);
  const std::vector<sizing::SizeSource> sources{{{0.75, 0, 0}, 0.008}};
  const auto field =
      sizing::SizeField::build(model.bounds(), sources, {.minimum = 0.008, .maximum = 0.06, .growth = 1.2});
  FaceMesh mesh = torus_mesh(model, 0.05);
  const FaceMesh before = mesh;
  remesh_interior(model, field, {.sweeps = 20}, mesh);
  const Measure last = measure(model, mesh);
  EXPECT_EQ(last.euler, 0);
  EXPECT_GE(last.worst, std::min(0.65, measure(model, before).worst));
  EXPECT_GT(last.mean, 0.93);
  EXPECT_GT(last.smallest_angle, 20);
  std::size_t fine = 0;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = mesh.points[t[i]], b = mesh.points[t[(i + 1) % 3]];
      fine += distance(a, b) > 1.8 * field(0.5 * (a + b));
    }
  }
  EXPECT_EQ(fine, 0u) << "edges longer than asked for are left";
}

// What a surface that answers wrongly could do to a mesh: its triangles get far larger than they were.
TEST(Remesh, DividesNoMoreThanTheSizesAskFor) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::box);
  const Vec3 normal = model.face_frame(0, {0, 0}).normal;
  const Vec3 u = std::abs(normal.x) > 0.5 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, v = cross(normal, u);
  FaceMesh mesh =
      grid_mesh(model, 0, {10, 10, false, false},
                [&](double s, double t) { return 0.5 * normal + (s - 0.5) * u + (t - 0.5) * v; }, {});
  const std::size_t count = mesh.points.size();
  const auto field = uniform_field(model, 0.1);
  FaceRemesher remesher(model, field, mesh);
  for (Vec3& point : mesh.points) point = point + 19.0 * (point - dot(point, normal) * normal);
  remesher.divide_long_edges();
  EXPECT_GT(mesh.points.size(), 5 * count);
  EXPECT_LT(mesh.points.size(), 12 * count);
}

TEST(Remesh, GivesTheSameBitsEveryTime) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::torus);
  FaceMesh first = torus_mesh(model, 0.05);
  shake(model, 0.01, first);
  FaceMesh second = first;
  const auto field = uniform_field(model, 0.05);
  remesh_interior(model, field, {.sweeps = 3}, first);
  remesh_interior(model, field, {.sweeps = 3}, second);
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.uv, second.uv);
  EXPECT_EQ(first.triangles, second.triangles);
}

TEST(Remesh, LeavesAnOctahedronAlone) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::sphere);
  FaceMesh mesh;
  mesh.face = 0;
  for (const Vec3 p :
       {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    const auto at = model.project(0, 0.25 * p, {0.1, 0.1});
    mesh.points.push_back(at.point);
    mesh.uv.push_back(at.uv);
  }
  for (int i = 0; i < 4; ++i) {
    mesh.triangles.push_back({i, (i + 1) % 4, 4});
    mesh.triangles.push_back({(i + 1) % 4, i, 5});
  }
  orient(model, mesh);
  remesh_interior(model, uniform_field(model, 10), {.sweeps = 5}, mesh);  // every edge is far too short
  const Measure last = measure(model, mesh);
  EXPECT_EQ(last.euler, 2);
  EXPECT_EQ(last.border_edges, 0);
}

}  // namespace
}  // namespace aeroloom::surface
