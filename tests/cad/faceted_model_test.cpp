#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/faceted_geometry.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "cad/model/facets/corner_parameters.hpp"
#include "cad/model/model_data.hpp"
#include "geometry/angle.hpp"
#include "geometry/predicates.hpp"
#include "tests/cad/faceted_shapes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double feature_angle = 40 * geometry::degree;

FacetComplex complex_of(FacetSoup soup) {
  Changes changes;
  return make_facet_complex(std::move(soup), feature_angle, changes);
}

Model fluid_of(FacetSoup soup) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  return make_faceted_domain(options, complex_of(std::move(soup)), {}).model;
}

/// A torus of facets: one face without any edge.
FacetSoup torus_soup(int around, int across) {
  FacetSoup soup = faceted::empty_soup();
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * k / across;
      const double r = 2 + 0.7 * std::cos(b);
      soup.points.push_back({r * std::cos(a), r * std::sin(a), 0.7 * std::sin(b)});
    }
  }
  const auto at = [&](int i, int k) { return (i % around) * across + k % across; };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      faceted::add_triangle(soup, at(i, k), at(i + 1, k), at(i + 1, k + 1));
      faceted::add_triangle(soup, at(i, k), at(i + 1, k + 1), at(i, k + 1));
    }
  }
  return soup;
}

TEST(FacetedModel, BoxIsItself) {
  const Model model = fluid_of(faceted::box_soup({0, 0, 0}, {3, 2, 1}));
  ASSERT_EQ(model.face_count(), 6);
  EXPECT_EQ(model.edge_count(), 12);
  EXPECT_EQ(model.vertex_count(), 8);
  EXPECT_EQ(model.region_count(), 1);
  EXPECT_NEAR(model.region_volume(0), 6, 1e-14);
  for (FaceId f = 0; f < 6; ++f) {
    EXPECT_TRUE(model.is_faceted(f));
    EXPECT_TRUE(model.is_planar(f));
    EXPECT_TRUE(model.is_exact_plane(f));
    ASSERT_EQ(model.face(f).loops.size(), 1u);
    EXPECT_EQ(model.face(f).loops[0].size(), 4u);
    EXPECT_EQ(model.face(f).front, 0);
    EXPECT_EQ(model.face(f).back, no_entity);
    const Vec3 out = model.face_area_vector(f);
    EXPECT_GT(dot(out, model.face_place(f).centre - Vec3{1.5, 1, 0.5}), 0);
  }
  EXPECT_EQ(model.patches().size(), 6u);  // the sides of the box
}

TEST(FacetedModel, EdgesLieOnBothFaces) {
  const Model model = fluid_of(faceted::cylinder_soup(24, 5, 3));
  ASSERT_EQ(model.face_count(), 3);
  int passes = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    for (const auto& loop : model.face(f).loops) {
      for (const Coedge& use : loop) {
        const Edge& edge = model.edge(use.edge);
        EXPECT_FALSE(model.is_seam(use.edge));
        for (int i = 0; i <= 40; ++i) {
          const double t = edge.first_parameter + i / 40.0 * (edge.last_parameter - edge.first_parameter);
          const Vec3 on_edge = model.edge_point(use.edge, t);
          EXPECT_LT(distance(on_edge, model.face_point(f, model.edge_uv(f, use, t))), 1e-11);
        }
        // A rim: a polygon of 24 sides around radius 1.
        EXPECT_NEAR(model.edge_curvature(use.edge, 0.3 * edge.last_parameter), 1, 0.02);
        ++passes;
      }
    }
  }
  EXPECT_EQ(passes, 4);
}

TEST(FacetedModel, ParametersLeadToTheFacets) {
  const Model model = fluid_of(torus_soup(60, 30));
  ASSERT_EQ(model.face_count(), 1);
  EXPECT_EQ(model.edge_count(), 0);
  EXPECT_GT(model.sheet_count(0), 3);
  const Facets facets = model.facets(0, 1, 1);
  const auto uv = corner_parameters(model, 0);
  ASSERT_EQ(uv.size(), facets.triangles.size());
  for (std::size_t t = 0; t < uv.size(); ++t) {
    ASSERT_EQ(geometry::orient2d(uv[t][0], uv[t][1], uv[t][2]), 1);
    Vec3 expected;
    Vec2 at;
    constexpr double weights[3] = {0.5, 0.2, 0.3};
    for (int i = 0; i < 3; ++i) {
      expected += weights[i] * facets.points[facets.triangles[t][i]];
      at += weights[i] * uv[t][i];
    }
    // No other triangle lies there in the plane.
    EXPECT_LT(distance(model.face_point(0, at), expected), 1e-10);
    EXPECT_EQ(model.sheet(0, at), model.sheet(0, uv[t][0]));
    const SurfaceFrame frame = model.face_frame(0, at);
    const double ring = std::hypot(expected.x, expected.y);
    const Vec3 spine{2 * expected.x / ring, 2 * expected.y / ring, 0};
    EXPECT_GT(dot(frame.normal, normalized(expected - spine)), 0.98);
    EXPECT_GT(dot(normalized(cross(frame.du, frame.dv)), frame.normal), 0.97);
    const PrincipalCurvatures bend = model.face_curvatures(0, at);
    EXPECT_NEAR(bend.largest, 1 / 0.7, 0.1);
  }
}

TEST(FacetedModel, ProjectionIsTheNearestPoint) {
  const Model model = fluid_of(torus_soup(60, 30));
  const Facets facets = model.facets(0, 1, 1);
  const auto uv = corner_parameters(model, 0);
  for (int i = 0; i < 200; ++i) {
    const double a = 0.7 * i, b = 1.3 * i, r = 2 + (0.7 + 0.1 * std::sin(i)) * std::cos(b);
    const Vec3 point{r * std::cos(a), r * std::sin(a), (0.7 + 0.1 * std::sin(i)) * std::sin(b)};
    const Projection found = model.project(0, point, uv[(37 * i) % uv.size()][0]);
    ASSERT_TRUE(found.converged);
    EXPECT_LT(distance(model.face_point(0, found.uv), found.point), 1e-10);
    for (const Vec3 p : facets.points) EXPECT_LE(distance(point, found.point), distance(point, p) + 1e-12);
    EXPECT_LT(std::abs(std::hypot(std::hypot(found.point.x, found.point.y) - 2, found.point.z) - 0.7), 0.02);
  }
}

TEST(FacetedModel, BytesGiveTheSameModel) {
  const Model model = fluid_of(faceted::cylinder_soup(24, 5, 3));
  const std::vector<std::byte> bytes = model.serialise();
  const Model again = Model::from_bytes(bytes);
  EXPECT_EQ(again.serialise(), bytes);
  ASSERT_EQ(again.face_count(), model.face_count());
  ASSERT_EQ(again.edge_count(), model.edge_count());
  for (FaceId f = 0; f < model.face_count(); ++f) {
    EXPECT_EQ(again.facets(f, 1, 1).uv, model.facets(f, 1, 1).uv);
    EXPECT_EQ(again.face(f).name, model.face(f).name);
    EXPECT_EQ(corner_parameters(again, f), corner_parameters(model, f));
  }
  EXPECT_THROW(Model::from_bytes(std::span(bytes).first(bytes.size() - 9)), CadError);
}

TEST(FacetedModel, FluidAroundABodyLeavesCavitiesOut) {
  FacetSoup soup = faceted::box_soup({-1, -1, -1}, {1, 1, 1});
  faceted::add_box(soup, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, true);
  DomainOptions options;
  options.far_field = FarFieldOptions{};
  const Domain domain = make_faceted_domain(options, complex_of(std::move(soup)), {});
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  const Model& model = domain.model;
  ASSERT_EQ(model.face_count(), 7);
  EXPECT_TRUE(model.is_far_field(0));
  EXPECT_FALSE(model.is_faceted(0));
  for (FaceId f = 1; f < 7; ++f) {
    EXPECT_TRUE(model.is_faceted(f));
    // Out of the fluid: into the body.
    EXPECT_LT(dot(model.face_area_vector(f), model.face_place(f).centre), 0);
  }
  const double radius = 20;
  EXPECT_NEAR(model.region_volume(0), 4 * std::numbers::pi / 3 * std::pow(radius, 3) - 8, 0.5);
  EXPECT_EQ(domain.report.changes.size(), 1u);
  options.far_field->symmetry = Symmetry::y;
  EXPECT_THROW(make_faceted_domain(options, complex_of(faceted::box_soup({-1, -1, -1}, {1, 1, 1})), {}),
               CadError);
}

/// A plate whose top has a ridge that ends inside: the face on both sides is divided there.
TEST(FacetedModel, NoFaceHasBothSidesOfACurve) {
  FacetComplex complex = complex_of(torus_soup(24, 12));
  const auto next = [&](std::int32_t p) { return (p + 12) % (24 * 12); };
  complex.curves = {{{0, next(0), next(next(0))}}};
  complex.vertices = {0, next(next(0))};
  const FacetedGeometry part = make_faceted_geometry(complex);
  EXPECT_GE(part.faces().size(), 2u);
  std::int32_t triangles = 0;
  for (const FacetedFace& face : part.faces()) triangles += face.count;
  EXPECT_EQ(triangles, 24 * 12 * 2);
  for (const FacetedEdge& edge : part.edges()) EXPECT_EQ(edge.uses.size(), 2u);
}

/// A wing that closes to a sharp edge, in sections ever nearer to it, written with six digits. Its ends run
/// to a point between the sides, in triangles as small as the last digits.
TEST(FacetedModel, EndsOfASharpTrailingEdgeStayFaces) {
  FacetSoup soup = faceted::empty_soup();
  const auto add = [&](double x, double y, double z) { soup.points.push_back({x, y, z}); };
  const double sections[] = {0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99996, 0.99997, 0.999978, 0.999985, 0.99999};
  for (const double x : sections) {
    for (const double y : {-0.5, 0.5}) add(x, y, 0.14 * (1 - x)), add(x, y, -0.14 * (1 - x));
  }
  const auto edge = static_cast<std::int32_t>(soup.points.size());
  for (const double y : {-0.5, 0.5}) add(1, y, 0);
  const auto add_quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    faceted::add_triangle(soup, a, b, c);
    faceted::add_triangle(soup, a, c, d);
  };
  add_quad(0, 2, 3, 1);  // the blunt front
  for (std::int32_t s = 0; s + 4 < edge; s += 4) {
    add_quad(s, s + 4, s + 6, s + 2);      // above
    add_quad(s + 1, s + 3, s + 7, s + 5);  // below
    add_quad(s, s + 1, s + 5, s + 4);      // y = -0.5
    add_quad(s + 2, s + 6, s + 7, s + 3);  // y = 0.5
  }
  const std::int32_t last = edge - 4;
  add_quad(last, edge, edge + 1, last + 2);
  add_quad(last + 1, last + 3, edge + 1, edge);
  faceted::add_triangle(soup, last, last + 1, edge);
  faceted::add_triangle(soup, last + 2, edge + 1, last + 3);
  const FacetComplex complex = complex_of(std::move(soup));
  EXPECT_EQ(complex.faces.size(), 5u);
  EXPECT_EQ(complex.curves.size(), 9u);
  EXPECT_EQ(complex.vertices.size(), 6u);
}

/// A torus of needles: the division goes along them, not to and fro.
TEST(FacetedModel, FacesAreDividedAlongNeedles) {
  constexpr std::int32_t sections = 7, around = 160;
  FacetComplex complex = complex_of(torus_soup(sections, around));
  complex.curves = {{{0, 1, 2, 3, 4, 5}}};
  complex.vertices = {0, 5};
  const FacetedGeometry part = make_faceted_geometry(complex);
  EXPECT_GE(part.faces().size(), 2u);
  const auto& points = part.complex().points;
  for (const FacetedEdge& edge : part.edges()) {
    for (std::size_t i = 1; i + 1 < edge.points.size(); ++i) {
      const Vec3 before = points[edge.points[i]] - points[edge.points[i - 1]];
      const Vec3 after = points[edge.points[i + 1]] - points[edge.points[i]];
      EXPECT_GT(dot(before, after), -0.9 * norm(before) * norm(after));
    }
  }
}

}  // namespace
}  // namespace aeroloom::cad
