#include "cad/model/evaluation/point_locator.hpp"

#include "tests/cad/primitives.hpp"

#include <random>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

class Locating : public testing::TestWithParam<PrimitiveKind> {
protected:
  Model model = make_primitive_domain(GetParam());
  PointLocator locator{model};
};

TEST_P(Locating, FindsPointsOfFaces) {
  std::mt19937 random(1);
  const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, 0.05, 0.5);
    for (int i = 0; i < 50; ++i) {
      const auto& t = facets.triangles[random() % facets.triangles.size()];
      const double a = share(), b = (1 - a) * share();
      const Vec2 uv = a * facets.uv[t[0]] + b * facets.uv[t[1]] + (1 - a - b) * facets.uv[t[2]];
      const Vec3 p = model.face_point(f, uv);
      const auto found = locator.on_face(f, p, 1e-9);
      ASSERT_TRUE(found) << "face " << f;
      EXPECT_LT(distance(model.face_point(f, *found), p), 1e-9);
      const Vec3 beside = p + 1e-3 * model.face_frame(f, uv).normal;
      EXPECT_FALSE(locator.on_face(f, beside, 1e-4));
      EXPECT_TRUE(locator.on_face(f, beside, 2e-3));
    }
  }
}

TEST_P(Locating, FindsPointsOfCurves) {
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const Edge& edge = model.edge(e);
    if (edge.degenerate) continue;
    for (int i = 1; i < 10; ++i) {
      const double parameter = edge.first_parameter + 0.1 * i * (edge.last_parameter - edge.first_parameter);
      const Vec3 p = model.edge_point(e, parameter);
      const auto found = locator.on_edge(e, p, 1e-9);
      ASSERT_TRUE(found) << "edge " << e;
      EXPECT_NEAR(*found, parameter, 1e-7 * (edge.last_parameter - edge.first_parameter));
      EXPECT_FALSE(locator.on_edge(e, p + Vec3{0.01, 0.01, 0.01}, 1e-4));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Locating,
                         testing::Values(PrimitiveKind::box, PrimitiveKind::sphere, PrimitiveKind::cylinder,
                                         PrimitiveKind::torus));

}  // namespace
}  // namespace aeroloom::cad
