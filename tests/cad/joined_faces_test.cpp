#include "cad/model/topology/joined_faces.hpp"

#include "cad/model/evaluation/face_width.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double strip_degrees = 4, height = 2;

std::vector<FaceId> curved_faces(const Model& model) {
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (!model.is_planar(f)) faces.push_back(f);
  }
  return faces;
}

struct Joined {
  Model apart = shapes::split_cylinder(strip_degrees, height);
  Model model = join_faces(apart, {curved_faces(apart)});
  FaceId side = curved_faces(model).front();
};

TEST(JoinedFaces, KeepsEverythingElse) {
  const Joined joined;
  ASSERT_EQ(joined.apart.face_count(), 4);
  ASSERT_EQ(joined.model.face_count(), 3);
  EXPECT_EQ(joined.model.edge_count(), joined.apart.edge_count());
  EXPECT_EQ(joined.model.sheet_count(joined.side), 2);
  EXPECT_NEAR(joined.model.face_area(joined.side), 2 * std::numbers::pi * height, 1e-9);
  int seams = 0;
  for (EdgeId e = 0; e < joined.model.edge_count(); ++e) {
    seams += joined.model.is_seam(e);
    for (const FaceId f : joined.model.edge(e).faces) EXPECT_LT(f, joined.model.face_count());
  }
  EXPECT_EQ(seams, 2);
  // The name is that of the larger one.
  const auto faces = curved_faces(joined.apart);
  const FaceId wide =
      joined.apart.face_area(faces[0]) > joined.apart.face_area(faces[1]) ? faces[0] : faces[1];
  EXPECT_EQ(joined.model.face(joined.side).name, joined.apart.face(wide).name);
}

TEST(JoinedFaces, EvaluatesOnEverySheet) {
  const Joined joined;
  for (const auto& loop : joined.model.face(joined.side).loops) {
    for (const Coedge& use : loop) {
      const Edge& edge = joined.model.edge(use.edge);
      for (const double share : {0.0, 0.3, 0.8, 1.0}) {
        const double t = edge.first_parameter + share * (edge.last_parameter - edge.first_parameter);
        const Vec2 uv = joined.model.edge_uv(joined.side, use, t);
        EXPECT_LT(distance(joined.model.face_point(joined.side, uv), joined.model.edge_point(use.edge, t)),
                  1e-9);
        const Vec3 p = joined.model.edge_point(use.edge, t);
        const SurfaceFrame frame = joined.model.face_frame(joined.side, uv);
        EXPECT_LT(distance(frame.normal, {p.x, p.y, 0}), 1e-9);
        EXPECT_NEAR(joined.model.face_curvatures(joined.side, uv).largest, 1, 1e-9);
      }
    }
  }
}

TEST(JoinedFaces, ProjectsAcrossBorders) {
  const Joined joined;
  const auto at = [](double degrees, double z) {
    const double a = degrees * std::numbers::pi / 180;
    return Vec3{std::cos(a), std::sin(a), z};
  };
  Projection last =
      joined.model.project(joined.side, at(180, 1), joined.model.facets(joined.side, 0.1, 0.5).uv[0]);
  ASSERT_TRUE(last.converged);
  std::vector<char> seen(2, 0);
  // Small steps through the strip and back out, as smoothing makes them.
  for (double degrees = 30; degrees > -30; degrees -= 0.5) {
    last = joined.model.project(joined.side, 1.001 * at(degrees, 1.2), last.uv);
    ASSERT_TRUE(last.converged);
    EXPECT_LT(distance(last.point, {std::cos(degrees * std::numbers::pi / 180),
                                    std::sin(degrees * std::numbers::pi / 180), 1.2 * 1.001}),
              1e-9);
    EXPECT_LT(distance(joined.model.face_point(joined.side, last.uv), last.point), 1e-9);
    seen[joined.model.sheet(joined.side, last.uv)] = 1;
    if (std::abs(degrees) < 0.1 || std::abs(degrees - strip_degrees) < 0.1) continue;
    const bool in_strip = degrees > 0 && degrees < strip_degrees;
    const auto faces = curved_faces(joined.apart);
    const std::int32_t narrow = joined.apart.face_area(faces[0]) < joined.apart.face_area(faces[1]) ? 0 : 1;
    EXPECT_EQ(joined.model.sheet(joined.side, last.uv) == narrow, in_strip) << degrees;
  }
  EXPECT_TRUE(seen[0] && seen[1]);
}

Vec3 on_cylinder(double degrees, double z) {
  const double a = degrees * std::numbers::pi / 180;
  return {std::cos(a), std::sin(a), z};
}

// Splines hold points beyond their end there: the nearest point is on another sheet, next to it or beyond.
TEST(JoinedFaces, ProjectsPastTheEndsOfSurfaces) {
  const Model apart = shapes::spline_cylinder(strip_degrees, height);
  const Model model = join_faces(apart, {curved_faces(apart)});
  ASSERT_EQ(model.face_count(), 3);
  const FaceId side = curved_faces(model).front();
  ASSERT_EQ(model.sheet_count(side), 3);
  const Vec2 somewhere = model.facets(side, 0.1, 0.5).uv[0];
  Vec2 start = somewhere;
  for (double degrees = 179; degrees > -30; degrees -= 1)
    start = model.project(side, on_cylinder(degrees, 1), start).uv;
  for (const double from :
       {-29.0, -3.0, -0.01, 0.01, 1.0, strip_degrees - 0.01, strip_degrees + 0.01, 12.0}) {
    start = model.project(side, on_cylinder(from, 1), start).uv;
    for (const double to : {-20.0, -1.0, 0.5, 3.0, strip_degrees + 1, 25.0}) {
      const Projection found = model.project(side, 0.98 * on_cylinder(to, 1.1), start);
      ASSERT_TRUE(found.converged);
      EXPECT_LT(distance(found.point, on_cylinder(to, 0.98 * 1.1)), 1e-9) << from << " to " << to;
      EXPECT_LT(distance(model.face_point(side, found.uv), found.point), 1e-9);
    }
  }
}

// The corner of a strip is nearest to what lies beyond the strip's end alone.
TEST(JoinedFaces, KeepsPointsOnTheRim) {
  const Model apart = shapes::spline_cylinder(strip_degrees, height);
  const Model model = join_faces(apart, {curved_faces(apart)});
  const FaceId side = curved_faces(model).front();
  Vec2 start = model.facets(side, 0.1, 0.5).uv[0];
  for (double degrees = 179; degrees > -5; degrees -= 1) {
    const Projection found = model.project(side, on_cylinder(degrees, height + 0.3), start);
    ASSERT_TRUE(found.converged);
    EXPECT_LT(distance(found.point, on_cylinder(degrees, height)), 1e-7) << degrees;
    start = found.uv;
  }
}

TEST(JoinedFaces, FacetsCoverAllSheets) {
  const Joined joined;
  const Facets facets = joined.model.facets(joined.side, 0.01, 0.2);
  double area = 0;
  for (const auto& [a, b, c] : facets.triangles) {
    area += 0.5 * norm(cross(facets.points[b] - facets.points[a], facets.points[c] - facets.points[a]));
  }
  EXPECT_NEAR(area, 2 * std::numbers::pi * height, 0.1);
  std::vector<int> coedges(joined.model.edge_count(), 0);
  for (const auto& line : facets.boundary) {
    ++coedges[line.use.edge];
    for (std::size_t i = 0; i < line.nodes.size(); ++i) {
      const Vec2 uv = joined.model.edge_uv(joined.side, line.use, line.parameters[i]);
      EXPECT_LT(distance(joined.model.face_point(joined.side, uv), facets.points[line.nodes[i]]), 1e-6);
    }
  }
  for (EdgeId e = 0; e < joined.model.edge_count(); ++e) {
    EXPECT_EQ(coedges[e], joined.model.is_seam(e) ? 2 : 1);
  }
}

TEST(JoinedFaces, RefusesWhatIsNotOneSurface) {
  const Model apart = shapes::split_cylinder(strip_degrees, height);
  const auto curved = curved_faces(apart);
  FaceId flat = 0;
  while (!apart.is_planar(flat)) ++flat;
  EXPECT_THROW(join_faces(apart, {{curved[0], flat}}), std::invalid_argument);
  EXPECT_THROW(join_faces(apart, {curved, curved}), std::invalid_argument);
  EXPECT_THROW(join_faces(join_faces(apart, {curved}), {{0, 1}}), std::invalid_argument);
}

TEST(FaceWidth, IsThatOfAStrip) {
  const Model model = shapes::split_cylinder(strip_degrees, 20);
  double least = 1e300;
  for (FaceId f = 0; f < model.face_count(); ++f) least = std::min(least, mean_width(model, f));
  const double width = strip_degrees * std::numbers::pi / 180;
  EXPECT_NEAR(least, 2 * 20 * width / (2 * (20 + width)), 1e-4);
}

TEST(FaceWidth, OfAClosedSurfaceIsItsExtent) {
  EXPECT_NEAR(mean_width(make_primitive_domain(PrimitiveKind::sphere, {.radius = 2}), 0),
              std::sqrt(16 * std::numbers::pi), 1e-9);
}

}  // namespace
}  // namespace aeroloom::cad
