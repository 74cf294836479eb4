#include "surface/charts/chart_surface.hpp"

#include "surface/charts/surface_topology.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/surface/face_fixture.hpp"

#include <set>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::make_primitive_domain;
using cad::Model;
using cad::PrimitiveKind;
using geometry::Vec3;
using testing::facets_of;
using testing::uniform_field;

struct Built {
  ChartSurface surface;
  FaceVertices vertices;
  std::vector<geometry::HalfEdge> twins;
  std::int64_t euler = 0;
  std::size_t loops = 0;
};

Built build(const Model& model, cad::FaceId face, const CurveMesh& curves, const sizing::SizeField& field) {
  Built built;
  built.surface = build_chart_surface(model, face, curves, facets_of(model, face), field, built.vertices);
  built.twins = geometry::match_half_edges(built.surface.triangles);
  const auto open = std::count(built.twins.begin(), built.twins.end(), -1);
  built.euler = static_cast<std::int64_t>(built.surface.points.size()) -
                (static_cast<std::int64_t>(built.twins.size()) + open) / 2 +
                static_cast<std::int64_t>(built.surface.triangles.size());
  built.loops = trace_boundary(built.surface, built.twins).size();
  return built;
}

/// What holds for every chart surface: loop edges join mesh vertices, mesh vertices are exact, corners agree
/// with the surface.
void expect_sound(const Model& model, const Built& built) {
  const ChartSurface& surface = built.surface;
  for (const auto& [a, b] : surface.loop_edges) {
    EXPECT_GE(surface.mesh_vertex[a], 0);
    EXPECT_GE(surface.mesh_vertex[b], 0);
    EXPECT_NE(surface.mesh_vertex[a], surface.mesh_vertex[b]);
  }
  std::set<std::int32_t> met;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (surface.mesh_vertex[i] < 0) continue;
    met.insert(surface.mesh_vertex[i]);
    EXPECT_EQ(surface.points[i], built.vertices.points[surface.mesh_vertex[i]]);
  }
  EXPECT_EQ(met.size(), built.vertices.points.size());
  const double close = 1e-6 * model.bounds().diagonal();
  for (std::size_t v = 0; v < built.vertices.points.size(); ++v) {
    EXPECT_LT(distance(model.face_point(surface.face, built.vertices.uv[v]), built.vertices.points[v]),
              close);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = surface.points[surface.triangles[t][i]];
      EXPECT_LT(distance(model.face_point(surface.face, surface.corner_uv[t][i]), p), close);
    }
  }
}

TEST(ChartSurface, SphereClosesToASphere) {
  const Model model = make_primitive_domain(PrimitiveKind::sphere);
  const auto field = uniform_field(model, 0.1);
  const Built built = build(model, 0, discretise_curves(model, field), field);
  EXPECT_EQ(built.loops, 0u);
  EXPECT_EQ(built.euler, 2);
  EXPECT_TRUE(built.surface.loop_edges.empty());
  EXPECT_TRUE(built.vertices.points.empty());
  expect_sound(model, built);
}

TEST(ChartSurface, TorusClosesToATorus) {
  const Model model = make_primitive_domain(PrimitiveKind::torus, {.radius = 0.2});
  const auto field = uniform_field(model, 0.1);
  const Built built = build(model, 0, discretise_curves(model, field), field);
  EXPECT_EQ(built.loops, 0u);
  EXPECT_EQ(built.euler, 0);
  expect_sound(model, built);
}

TEST(ChartSurface, CylinderHasATubeAndTwoDisks) {
  const Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const auto field = uniform_field(model, 0.05);
  const CurveMesh curves = discretise_curves(model, field);
  double area = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const Built built = build(model, f, curves, field);
    EXPECT_EQ(built.loops, model.is_planar(f) ? 1u : 2u);
    EXPECT_EQ(built.euler, model.is_planar(f) ? 1 : 0);
    EXPECT_EQ(built.surface.loop_edges.size(), 31 * built.loops);
    expect_sound(model, built);
    area += surface_area(built.surface);
  }
  EXPECT_NEAR(area, 2 * std::numbers::pi * 0.25 * 1.25, 0.02);
}

TEST(ChartSurface, MeshVerticesDivideCoarseFacets) {
  // Sizes far below the facets: each side of a box face has two triangles at most and 200 mesh vertices.
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const auto field = uniform_field(model, 0.005);
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const Built built = build(model, f, curves, field);
    EXPECT_EQ(built.surface.loop_edges.size(), 800u);
    EXPECT_EQ(built.euler, 1);
    EXPECT_NEAR(surface_area(built.surface), 1, 1e-12);
    expect_sound(model, built);
  }
}

TEST(ChartSurface, FollowsTheSurfaceUnderSizesFarBelowItsFacets) {
  // Mesh vertices lie on the circles, well outside the chords of the facets: no triangle may turn over for
  // it.
  const Model model = make_primitive_domain(PrimitiveKind::cylinder, {.radius = 0.25, .height = 0.004});
  const auto field = uniform_field(model, 0.002);
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const cad::Facets coarse = model.facets(f, 0.05, 1.2);
    FaceVertices vertices;
    const ChartSurface surface = build_chart_surface(model, f, curves, coarse, field, vertices);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& uv = surface.corner_uv[t];
      const Vec3 normal = model.face_frame(f, (uv[0] + uv[1] + uv[2]) / 3).normal;
      const Vec3 area = area_vector(surface, static_cast<std::int32_t>(t));
      EXPECT_GT(dot(area, normal), 0.8 * norm(area)) << "face " << f << " triangle " << t;
    }
  }
}

TEST(ChartSurface, IsNoFinerThanElementsThatCannotTurn) {
  const Model model = make_primitive_domain(PrimitiveKind::cylinder, {.radius = 0.25, .height = 0.5});
  const auto large = uniform_field(model, 10), small = uniform_field(model, 0.5);
  const CurveMesh curves = discretise_curves(model, large);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_planar(f)) continue;
    const cad::Facets coarse = model.facets(f, 0.05, 1.2);
    FaceVertices vertices, fine_vertices;
    const ChartSurface surface = build_chart_surface(model, f, curves, coarse, large, vertices);
    const ChartSurface fine = build_chart_surface(model, f, curves, coarse, small, fine_vertices);
    EXPECT_LT(surface.triangles.size(), 40u);
    EXPECT_GT(fine.triangles.size(), 2 * surface.triangles.size());
  }
}

TEST(ChartSurface, FacetNodesBetweenMeshVerticesRemain) {
  const Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const auto field = uniform_field(model, 10);
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const Built built = build(model, f, curves, field);
    EXPECT_EQ(built.surface.loop_edges.size(), 4 * built.loops);
    EXPECT_GT(std::count(built.twins.begin(), built.twins.end(), -1), 20 * static_cast<long>(built.loops));
    expect_sound(model, built);
  }
}

TEST(SurfaceTopology, PinchedBoundaryFallsApartIntoFans) {
  // Two triangles that touch in point 2 alone.
  ChartSurface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}};
  surface.triangles = {{0, 1, 2}, {2, 3, 4}};
  surface.corner_uv.resize(2);
  surface.mesh_vertex = {0, 1, 2, 3, 4};
  const ChartSurface apart =
      separate_parts(surface, geometry::match_half_edges(surface.triangles), {0, 0}, 1).front();
  EXPECT_EQ(apart.points.size(), 6u);
  EXPECT_EQ(std::count(apart.mesh_vertex.begin(), apart.mesh_vertex.end(), 2), 2);
  EXPECT_EQ(apart.loop_edges.size(), 6u);
}

TEST(SurfaceTopology, DividedEdgesKeepAreaAndConformity) {
  ChartSurface surface;
  surface.points = {{0, 0, 0},       {1, 0, 0},       {1, 1, 0},  {0, 1, 0},
                    {0.25, 0.25, 0}, {0.75, 0.75, 0}, {0.5, 0, 0}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  surface.corner_uv = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  surface.mesh_vertex.assign(7, -1);
  const auto former = divide_edges(surface, {{2, 0.75, 4, {0.25, 0.25}},
                                             {2, 0.25, 5, {0.75, 0.75}},
                                             {3, 0.25, 4, {0.25, 0.25}},
                                             {3, 0.75, 5, {0.75, 0.75}},
                                             {0, 0.5, 6, {0.5, 0}}});
  EXPECT_EQ(surface.triangles.size(), 7u);
  EXPECT_EQ(former.size(), 7u);
  EXPECT_NEAR(surface_area(surface), 1, 1e-15);
  const auto twins = geometry::match_half_edges(surface.triangles);
  EXPECT_EQ(std::count(twins.begin(), twins.end(), -1), 5);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = surface.points[surface.triangles[t][i]];
      EXPECT_EQ(surface.corner_uv[t][i], (geometry::Vec2{p.x, p.y}));
    }
  }
}

}  // namespace
}  // namespace aeroloom::surface
