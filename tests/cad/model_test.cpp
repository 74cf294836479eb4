#include "cad/model/model.hpp"

#include "tests/cad/model_checks.hpp"
#include "tests/cad/primitives.hpp"

#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using std::numbers::pi;

struct Shape {
  PrimitiveKind kind;
  const char* name;
  int faces;
  double area, volume;
};

const Shape shapes[] = {
    {PrimitiveKind::box, "box", 6, 6, 1},
    {PrimitiveKind::sphere, "sphere", 1, 4 * pi / 16, 4.0 / 3 * pi / 64},
    {PrimitiveKind::cylinder, "cylinder", 3, 2 * pi / 16 + 2 * pi * 0.25, pi / 16},
    {PrimitiveKind::torus, "torus", 1, 4 * pi* pi * 0.5 * 0.25, 2 * pi* pi * 0.5 / 16},
    {PrimitiveKind::box_with_sphere, "box_with_sphere", 7, 6 + 4 * pi / 16, 1 - 4.0 / 3 * pi / 64},
};

class Primitives : public testing::TestWithParam<Shape> {
protected:
  Model model = make_primitive_domain(GetParam().kind);
};

TEST_P(Primitives, HaveTheirAreaAndVolume) {
  double area = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) area += model.face_area(f);
  EXPECT_EQ(model.face_count(), GetParam().faces);
  EXPECT_NEAR(area, GetParam().area, 1e-9);
  EXPECT_NEAR(checks::facets_volume(model, 1e-3, 0.12), GetParam().volume, 0.01 * GetParam().volume);
}

TEST_P(Primitives, HaveClosedLoopsAndWatertightTopology) {
  checks::expect_closed_loops(model, 1e-9);
  checks::expect_watertight(model);
}

TEST_P(Primitives, HaveSoundFacets) {
  for (FaceId f = 0; f < model.face_count(); ++f) checks::expect_sound_facets(model, f, 1e-3, 0.2, 1e-6);
}

TEST_P(Primitives, FacetsStayCloseAndTurnLittle) {
  constexpr double deflection = 2e-3, angle = 0.25;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, deflection, angle);
    std::map<std::pair<int, int>, Vec3> normals;
    for (const auto& t : facets.triangles) {
      const Vec3 a = facets.points[t[0]], b = facets.points[t[1]], c = facets.points[t[2]];
      const Vec2 uv = (facets.uv[t[0]] + facets.uv[t[1]] + facets.uv[t[2]]) / 3.0;
      EXPECT_LT(distance((a + b + c) / 3.0, model.face_point(f, uv)), 2 * deflection);
      const Vec3 normal = cross(b - a, c - a);
      if (norm(normal) < 1e-12) continue;  // between two coedges of a pole
      for (int i = 0; i < 3; ++i) {
        const auto across = normals.find({t[(i + 1) % 3], t[i]});
        if (across != normals.end()) {
          EXPECT_GT(dot(across->second, normalized(normal)), std::cos(angle)) << "face " << f;
        }
        normals[{t[i], t[(i + 1) % 3]}] = normalized(normal);
      }
    }
  }
}

TEST_P(Primitives, BothCoedgesOfASeamCarryTheSameNodes) {
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, 1e-3, 0.2);
    for (const auto& line : facets.boundary) {
      for (const auto& other : facets.boundary) {
        if (line.use.edge != other.use.edge) continue;
        EXPECT_EQ(line.parameters, other.parameters) << "edge " << line.use.edge;
      }
    }
  }
}

TEST_P(Primitives, FacetsDoNotDependOnWhatWasTriangulatedBefore) {
  const Model fresh = Model::from_bytes(model.serialise());
  for (FaceId f = 0; f < model.face_count(); ++f) model.facets(f, 0.05, 0.8);
  for (FaceId f = model.face_count() - 1; f >= 0; --f) {
    const Facets a = model.facets(f, 1e-3, 0.2), b = fresh.facets(f, 1e-3, 0.2);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles);
  }
}

TEST_P(Primitives, AreTheSameFromTheirBytes) {
  const Model copy = Model::from_bytes(model.serialise());
  EXPECT_EQ(copy.serialise(), model.serialise());
  ASSERT_EQ(copy.face_count(), model.face_count());
  ASSERT_EQ(copy.edge_count(), model.edge_count());
  ASSERT_EQ(copy.vertex_count(), model.vertex_count());
  EXPECT_EQ(copy.patches(), model.patches());
  for (VertexId v = 0; v < model.vertex_count(); ++v) EXPECT_EQ(copy.vertex(v), model.vertex(v));
  for (FaceId f = 0; f < model.face_count(); ++f) {
    EXPECT_EQ(copy.face(f).name, model.face(f).name);
    EXPECT_EQ(copy.face(f).loops.size(), model.face(f).loops.size());
    EXPECT_EQ(copy.face_area(f), model.face_area(f));
  }
}

TEST_P(Primitives, ProjectionReturnsPointsOfTheSurface) {
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, 0.01, 0.4);
    for (const auto& t : facets.triangles) {
      const Vec2 uv = (facets.uv[t[0]] + facets.uv[t[1]] + facets.uv[t[2]]) / 3.0;
      const SurfaceFrame frame = model.face_frame(f, uv);
      if (frame.normal == Vec3{}) continue;
      const Projection found = model.project(f, frame.point + 0.02 * frame.normal, facets.uv[t[1]]);
      EXPECT_TRUE(found.converged);
      EXPECT_LT(distance(found.point, frame.point), 1e-7) << "face " << f;
      EXPECT_LT(distance(model.face_point(f, found.uv), found.point), 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, Primitives, testing::ValuesIn(shapes),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Model, NamesTheSidesOfABox) {
  const Model model = make_primitive_domain(PrimitiveKind::box, {.box = {1, 2, 4}});
  EXPECT_EQ(std::set(model.patches().begin(), model.patches().end()),
            (std::set<std::string>{"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}));
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const std::string& name = model.face(f).name;
    const int axis = name[0] - 'x';
    const Facets facets = model.facets(f, 0.1, 0.5);
    const double wanted = 0.5 * Vec3{1, 2, 4}[axis] * (name.substr(1) == "min" ? -1 : 1);
    for (const Vec3 p : facets.points) EXPECT_NEAR(p[axis], wanted, 1e-12) << name;
  }
  EXPECT_NEAR(distance(model.bounds().low, {-0.5, -1, -2}), 0, 1e-12);
  EXPECT_NEAR(distance(model.bounds().high, {0.5, 1, 2}), 0, 1e-12);
}

TEST(Model, KnowsItsFarField) {
  const Model model =
      make_primitive_domain(PrimitiveKind::box_with_sphere, {.box = {10, 10, 10}, .radius = 0.5});
  int far = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) far += model.is_far_field(f);
  EXPECT_EQ(far, 6);
  EXPECT_EQ(model.patches().size(), 2u);
  EXPECT_NEAR(model.body_bounds().size().x, 1, 1e-9);
  EXPECT_NEAR(model.bounds().size().x, 10, 1e-9);
}

TEST(Model, OneEvaluationGivesPointAndCurvatures) {
  for (const PrimitiveKind kind : {PrimitiveKind::torus, PrimitiveKind::box_with_sphere}) {
    const Model model = make_primitive_domain(kind);
    for (FaceId f = 0; f < model.face_count(); ++f) {
      const Vec2 uv{0.3, 0.2};
      const CurvedPoint both = model.face_curved_point(f, uv);
      EXPECT_EQ(both.point, model.face_point(f, uv));
      EXPECT_EQ(both.curvatures.largest, model.face_curvatures(f, uv).largest);
      EXPECT_EQ(both.curvatures.defined, model.face_curvatures(f, uv).defined);
    }
  }
}

TEST(Model, CurvaturesOfKnownSurfaces) {
  const Model torus = make_primitive_domain(PrimitiveKind::torus, {.radius = 0.25, .major_radius = 0.75});
  const PrincipalCurvatures outside = torus.face_curvatures(0, {0.3, 0});
  EXPECT_TRUE(outside.defined);
  EXPECT_NEAR(outside.largest, 4, 1e-12);
  EXPECT_NEAR(outside.smallest, 1, 1e-12);
  EXPECT_NEAR(torus.face_curvatures(0, {0.3, pi}).smallest, 2, 1e-12);
  EXPECT_FALSE(make_primitive_domain(PrimitiveKind::sphere).face_curvatures(0, {0, pi / 2}).defined);
}

TEST(Model, RefusesDamagedBytes) {
  auto bytes = make_primitive_domain(PrimitiveKind::box).serialise();
  EXPECT_THROW(Model::from_bytes(std::span(bytes).first(100)), CadError);
  EXPECT_THROW(Model::from_bytes(std::span(bytes).first(bytes.size() / 2)), CadError);
  EXPECT_THROW(Model::from_bytes({}), CadError);
  bytes[0] = std::byte{0};
  EXPECT_THROW(Model::from_bytes(bytes), CadError);
}

TEST(Model, RefusesImpossibleShapes) {
  EXPECT_THROW(make_primitive_domain(PrimitiveKind::sphere, {.radius = -1}), CadError);
  EXPECT_THROW(make_primitive_domain(PrimitiveKind::box_with_sphere, {.radius = 2}), CadError);
}

}  // namespace
}  // namespace aeroloom::cad
