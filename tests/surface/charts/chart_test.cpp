#include "surface/charts/chart.hpp"

#include "cad/domain/domain.hpp"
#include "geometry/predicates.hpp"
#include "surface/charts/conformal_map.hpp"
#include "surface/charts/surface_topology.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/surface/face_fixture.hpp"

#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::make_primitive_domain;
using cad::Model;
using cad::PrimitiveKind;
using geometry::Vec2;
using geometry::Vec3;
using testing::facets_of;
using testing::uniform_field;

struct ChartedFace {
  ChartSurface whole;
  FaceVertices vertices;
  std::vector<Chart> charts;
};

ChartedFace chart_face(const Model& model, cad::FaceId face, const CurveMesh& curves,
                       const sizing::SizeField& field) {
  ChartedFace result;
  result.whole = build_chart_surface(model, face, curves, facets_of(model, face), field, result.vertices);
  result.charts = make_charts(model, field, result.whole, {}, result.vertices);
  return result;
}

/// Charts cover the face, are one-to-one, and their loops fit each other: every loop edge of the face occurs
/// once, every cut edge once in each direction.
void expect_sound(const ChartedFace& face) {
  double area = 0;
  std::map<std::array<std::int32_t, 2>, int> edges;
  for (const Chart& chart : face.charts) {
    const ChartSurface& surface = chart.surface;
    area += surface_area(surface);
    const MapQuality quality = judge_map(surface, chart.plane);
    EXPECT_LE(quality.folded, 1e-4);
    EXPECT_LE(quality.overlap, 1e-3);
    EXPECT_LE(quality.stretch, 1.5);
    EXPECT_LE(quality.scale_ratio, 8);
    for (const auto& [a, b] : surface.loop_edges) {
      ASSERT_GE(surface.mesh_vertex[a], 0);
      ASSERT_GE(surface.mesh_vertex[b], 0);
      EXPECT_EQ(surface.points[a], face.vertices.points[surface.mesh_vertex[a]]);
      ++edges[{surface.mesh_vertex[a], surface.mesh_vertex[b]}];
    }
  }
  EXPECT_NEAR(area, surface_area(face.whole), 0.02 * area);
  for (const auto& [a, b] : face.whole.loop_edges) {
    EXPECT_EQ((edges[{face.whole.mesh_vertex[a], face.whole.mesh_vertex[b]}]--), 1);
  }
  for (const auto& [edge, count] : edges) {
    if (count == 0) continue;
    EXPECT_EQ(count, 1);
    EXPECT_EQ((edges.at({edge[1], edge[0]})), 1);
  }
}

TEST(Charts, PlaneFaceIsOneIsometricChart) {
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const auto field = uniform_field(model, 0.1);
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const ChartedFace face = chart_face(model, f, curves, field);
    ASSERT_EQ(face.charts.size(), 1u);
    for (const double scale : face.charts.front().scale) EXPECT_NEAR(scale, 1, 1e-12);
    expect_sound(face);
  }
}

TEST(Charts, SphereIsTwoHemispheres) {
  const Model model = make_primitive_domain(PrimitiveKind::sphere);
  const auto field = uniform_field(model, 0.05);
  const ChartedFace face = chart_face(model, 0, discretise_curves(model, field), field);
  EXPECT_EQ(face.charts.size(), 2u);
  EXPECT_EQ(face.vertices.border_count(), 0);
  for (const Vec3 p : face.vertices.points) EXPECT_NEAR(norm(p), 0.25, 1e-9);
  expect_sound(face);
}

TEST(Charts, TubeIsCutLengthwise) {
  for (const double height : {0.1, 1.0, 10.0}) {
    const Model model = make_primitive_domain(PrimitiveKind::cylinder, {.height = height});
    const auto field = uniform_field(model, 0.1);
    const CurveMesh curves = discretise_curves(model, field);
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      const ChartedFace face = chart_face(model, f, curves, field);
      EXPECT_LE(face.charts.size(), 4u);
      for (const Vec3 p : face.vertices.points) EXPECT_NEAR(std::hypot(p.x, p.y), 0.25, 1e-9);
      expect_sound(face);
    }
  }
}

TEST(Charts, TorusUnfolds) {
  for (const double size : {0.03, 0.2, 5.0}) {
    const Model model = make_primitive_domain(PrimitiveKind::torus, {.radius = 0.2});
    const auto field = uniform_field(model, size);
    const ChartedFace face = chart_face(model, 0, discretise_curves(model, field), field);
    EXPECT_LE(face.charts.size(), 8u);
    expect_sound(face);
  }
}

TEST(Charts, AreTheSameEveryTime) {
  const Model model = make_primitive_domain(PrimitiveKind::torus, {.radius = 0.2});
  const auto field = uniform_field(model, 0.1);
  const CurveMesh curves = discretise_curves(model, field);
  const ChartedFace first = chart_face(model, 0, curves, field), second = chart_face(model, 0, curves, field);
  ASSERT_EQ(first.charts.size(), second.charts.size());
  for (std::size_t i = 0; i < first.charts.size(); ++i) {
    EXPECT_EQ(first.charts[i].plane, second.charts[i].plane);
    EXPECT_EQ(first.charts[i].surface.triangles, second.charts[i].surface.triangles);
  }
}

/// A strip that winds around an axis: radii 1 and 2, rising so that it does not meet itself.
ChartSurface winding_strip(double turns, PlaneMap& flat) {
  constexpr int steps = 96;
  ChartSurface strip;
  flat.clear();
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2 * std::numbers::pi * turns * i / steps;
    for (const double radius : {1.0, 2.0}) {
      flat.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      strip.points.push_back({flat.back().x, flat.back().y, 0.01 * angle});
    }
  }
  for (std::int32_t i = 0; i < steps; ++i) {
    strip.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    strip.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  strip.corner_uv.resize(strip.triangles.size());
  strip.mesh_vertex.assign(strip.points.size(), -1);
  return strip;
}

TEST(MapQuality, SeesWhatLiesOverItself) {
  PlaneMap flat;
  const ChartSurface open = winding_strip(0.9, flat);
  EXPECT_EQ(judge_map(open, flat).overlap, 0);
  EXPECT_EQ(judge_map(open, flat).folded, 0);
  EXPECT_LT(judge_map(open, flat).stretch, 1.05);
  const ChartSurface winding = winding_strip(1.5, flat);
  EXPECT_NEAR(judge_map(winding, flat).overlap, 2 / 3.0, 0.05);
  EXPECT_EQ(judge_map(winding, flat).folded, 0);
}

TEST(MapQuality, SeesFolds) {
  PlaneMap flat;
  const ChartSurface strip = winding_strip(0.5, flat);
  for (Vec2& p : flat) p.x = -p.x;
  EXPECT_NEAR(judge_map(strip, flat).folded, 1, 1e-2);
}

TEST(ConformalMap, UnrollsADevelopableStripIsometrically) {
  // Half a cylinder of radius 1 and height 3.
  ChartSurface strip;
  constexpr int around = 40, along = 30;
  for (int i = 0; i <= around; ++i) {
    for (int j = 0; j <= along; ++j) {
      const double angle = std::numbers::pi * i / around;
      strip.points.push_back({std::cos(angle), std::sin(angle), 3.0 * j / along});
    }
  }
  for (std::int32_t i = 0; i < around; ++i) {
    for (std::int32_t j = 0; j < along; ++j) {
      const std::int32_t a = i * (along + 1) + j, b = a + along + 1;
      strip.triangles.push_back({a, b, b + 1});
      strip.triangles.push_back({a, b + 1, a + 1});
    }
  }
  strip.corner_uv.resize(strip.triangles.size());
  strip.mesh_vertex.assign(strip.points.size(), -1);
  const auto map = map_conformally(strip, project_to_mean_plane(strip));
  ASSERT_TRUE(map.has_value());
  const MapQuality quality = judge_map(strip, *map);
  EXPECT_EQ(quality.folded, 0);
  EXPECT_EQ(quality.overlap, 0);
  EXPECT_LT(quality.stretch, 1.001);
  EXPECT_LT(quality.scale_ratio, 1.001);
}

TEST(ChartLocator, FindsEveryPointAgain) {
  const Model model = make_primitive_domain(PrimitiveKind::sphere);
  const auto field = uniform_field(model, 0.1);
  const ChartedFace face = chart_face(model, 0, discretise_curves(model, field), field);
  for (const Chart& chart : face.charts) {
    const ChartLocator locator(chart);
    std::int32_t hint = -1;
    for (std::size_t i = 0; i < chart.plane.size(); ++i) {
      const ChartPoint at = locator.locate(chart.plane[i], hint);
      EXPECT_LT(distance(at.point, chart.surface.points[i]), 1e-9);
      EXPECT_NEAR(locator.scale(at), chart.scale[i], 1e-6 * chart.scale[i]);
    }
    for (std::size_t t = 0; t < chart.surface.triangles.size(); ++t) {
      const auto& [a, b, c] = chart.surface.triangles[t];
      const Vec2 p = 0.5 * chart.plane[a] + 0.3 * chart.plane[b] + 0.2 * chart.plane[c];
      std::int32_t far = static_cast<std::int32_t>(chart.surface.triangles.size() - 1 - t);
      const ChartPoint at = locator.locate(p, far);
      EXPECT_EQ(at.triangle, static_cast<std::int32_t>(t));
      EXPECT_NEAR(at.weights[0], 0.5, 1e-9);
      EXPECT_NEAR(at.weights[1], 0.3, 1e-9);
    }
  }
}

TEST(ChartLocator, ExtrapolatesBeyondTheEdge) {
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const auto field = uniform_field(model, 0.25);
  const ChartedFace face = chart_face(model, 0, discretise_curves(model, field), field);
  const Chart& chart = face.charts.front();
  const ChartLocator locator(chart);
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Vec2 p : chart.plane) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  std::int32_t hint = 0;
  const Vec2 outside{high.x + 0.1, 0.5 * (low.y + high.y)};
  const ChartPoint at = locator.locate(outside, hint);
  EXPECT_LT(std::min({at.weights[0], at.weights[1], at.weights[2]}), 0);
  const ChartPoint edge = locator.locate({high.x, outside.y}, hint);
  EXPECT_NEAR(distance(at.point, edge.point), 0.1, 1e-9);
}

class RealModel : public ::testing::TestWithParam<std::string> {};

TEST_P(RealModel, EveryFaceGetsCharts) {
  const auto file = testing::aircraft_folder() / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  cad::DomainOptions options;
  options.file = file.string();
  const Model model = cad::prepare_domain(options).model;
  const auto field = uniform_field(model, 0.01 * model.body_bounds().diagonal());
  const CurveMesh curves = discretise_curves(model, field);
  const double start = parallel::cpu_seconds();
  std::size_t charts = 0;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    SCOPED_TRACE(fmt::format("face {} {}", f, model.face(f).name));
    try {
      const ChartedFace face = chart_face(model, f, curves, field);
      charts += face.charts.size();
      expect_sound(face);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  fmt::print("RESULT model={} faces={} charts={} seconds={:.2f}\n", GetParam(), model.face_count(), charts,
             parallel::cpu_seconds() - start);
}

INSTANTIATE_TEST_SUITE_P(Aircraft, RealModel,
                         ::testing::Values("gmsh_dlr_f6.brep", "gmsh_wing_fuselage.step",
                                           "tigl_D150_wing.igs", "pyrefine_cev_capsule.igs",
                                           "gmsh_submarine.stp"));

}  // namespace
}  // namespace aeroloom::surface
