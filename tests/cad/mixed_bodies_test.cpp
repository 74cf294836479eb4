// Bodies of triangles that overlap, and bodies of CAD and of triangles in one domain.
#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/blunt_shapes.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double sharp_turn = 40 * geometry::degree;

TopoDS_Shape cad_box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}

FacetComplex unite(FacetSoup soup, Changes& changes) {
  return make_facet_complex(std::move(soup), sharp_turn, changes, CrossingFacets::unite);
}

/// A domain of bodies in a sphere, with one part "store" of these triangles.
Domain with_store(const TopoDS_Shape& bodies, const FacetSoup& store, DomainOptions options = {}) {
  const real::TemporaryFile file("store.stl", faceted::ascii_stl(store));
  options.parts.push_back({"store", file.path(), 1});
  return shapes::prepare(bodies, options);
}

std::string refusal_of_store(const TopoDS_Shape& bodies, const FacetSoup& store,
                             const DomainOptions& options = {}) {
  try {
    with_store(bodies, store, options);
  } catch (const CadError& error) {
    return error.what();
  }
  return {};
}

double sphere_volume(const Model& model) {
  return std::numbers::pi / 6 * std::pow(model.bounds().size().x, 3);
}

/// What is missing from the spherical far field.
double body_volume(const Model& model) {
  return sphere_volume(model) - model.region_volume(0);
}

TEST(MixedBodies, CrossingBoxesOfTrianglesBecomeOne) {
  FacetSoup soup = faceted::box_soup({0, 0, 0}, {2, 2, 2});
  soup.groups = {{"fuselage", {}}, {"wing", {}}};
  faceted::add_box(soup, {1, 1, 1}, {3, 3, 3}, true);  // turned inside out in the file
  Changes changes;
  const FacetComplex complex = unite(soup, changes);
  EXPECT_TRUE(complex.united);
  ASSERT_EQ(complex.regions.size(), 1U);
  EXPECT_DOUBLE_EQ(enclosed_volume(complex), 15);
  ASSERT_EQ(shapes::changes_about(changes, "'fuselage'").size(), 1U);
  EXPECT_EQ(complex.faces.size(), 12U);
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const FacetComplex::Face& face = complex.faces[complex.face_of[t]];
    for (const std::int32_t p : complex.triangles[t]) {
      const Vec3 at = complex.points[p];
      const bool in_first = std::max({at.x, at.y, at.z}) <= 2;
      EXPECT_TRUE(face.name == (in_first ? "fuselage" : "wing") || std::min({at.x, at.y, at.z}) >= 1);
    }
  }
}

TEST(MixedBodies, SeveralBodiesOfTrianglesAreUnitedInAnyOrder) {
  FacetSoup soup = faceted::box_soup({0, 0, 0}, {1, 1, 1});
  faceted::add_box(soup, {3, 0.25, 0.25}, {5, 0.75, 0.75});
  faceted::add_box(soup, {0.5, 0.25, 0.25}, {3.5, 0.75, 0.75});  // on both
  faceted::add_box(soup, {10, 10, 10}, {11, 11, 11});            // apart
  faceted::add_box(soup, {0.2, 0.2, 0.2}, {0.25, 0.25, 0.25});   // inside the first
  Changes changes;
  const FacetComplex walls = outer_walls(unite(soup, changes), changes);
  EXPECT_NEAR(-enclosed_volume(walls), 1 + 0.25 * 4 + 1, 1e-12);
}

TEST(MixedBodies, BodiesThatTouchAlongALineAreRefusedByName) {
  FacetSoup soup = faceted::box_soup({0, 0, 0}, {1, 1, 1});
  soup.groups = {{"left", {}}, {"right", {}}};
  faceted::add_box(soup, {1, 1, 0.25}, {2, 2, 0.75});
  Changes changes;
  try {
    unite(soup, changes);
    ADD_FAILURE() << "no union was refused";
  } catch (const CadError& error) {
    const std::string text = error.what();
    for (const char* const word : {"'left'", "'right'", "at (", "along a line", "Remedy"})
      EXPECT_NE(text.find(word), std::string::npos) << text;
  }
}

TEST(MixedBodies, ABallOfTrianglesStandsBesideACylinder) {
  const FacetSoup ball = faceted::ball_soup({0, 3, 0}, 0.5, 12);
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(1, 2).Shape();
  const Domain domain = with_store(cylinder, ball);
  const Model& model = domain.model;
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  checks::expect_watertight(model);
  EXPECT_NEAR(body_volume(model), 2 * std::numbers::pi + faceted::volume_of(ball), 1e-6);
  ASSERT_EQ(model.face_count(), 5);  // far field, three of the cylinder, the ball
  EXPECT_EQ(shapes::faces_of_patch(model, "store"), std::vector<FaceId>{4});
  for (FaceId f = 0; f < 5; ++f) {
    EXPECT_EQ(model.is_faceted(f), f == 4);
    EXPECT_EQ(model.face(f).front, 0);
    EXPECT_GT(model.face_area(f), 0);
  }
  EXPECT_EQ(model.face(4).part, "store");
  EXPECT_EQ(model.face(4).number, -1);
  EXPECT_EQ(Model::from_bytes(model.serialise()).serialise(), model.serialise());
}

TEST(MixedBodies, ScaleAndNamesOfGroups) {
  FacetSoup drum = faceted::cylinder_soup(16, 2, 3);
  const real::TemporaryFile file("drum.stl",
                                 faceted::ascii_stl(drum, "lower") +
                                     faceted::ascii_stl(faceted::box_soup({5, 0, 0}, {6, 1, 1}), "upper"));
  DomainOptions options;
  options.parts.push_back({"store", file.path(), 0.1});
  const Domain domain = shapes::prepare(cad_box({3, 3, 3}, {4, 4, 4}), options);
  EXPECT_NEAR(body_volume(domain.model), 1 + 1e-3 * (faceted::volume_of(drum) + 1), 1e-6);
  EXPECT_FALSE(shapes::faces_of_patch(domain.model, "store_lower").empty());
  EXPECT_EQ(shapes::faces_of_patch(domain.model, "store_upper").size(), 6U);
}

TEST(MixedBodies, ABoxOfCadThatTrianglesCrossIsUnitedWithThem) {
  const FacetSoup other = faceted::box_soup({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
  const Domain domain = with_store(cad_box({0, 0, 0}, {1, 1, 1}), other);
  const Model& model = domain.model;
  checks::expect_watertight(model);
  EXPECT_NEAR(body_volume(model), 2 - 0.125, 1e-7);
  EXPECT_EQ(shapes::faces_of_patch(model, "store").size(), 6U);
  EXPECT_EQ(shapes::faces_of_patch(model, "body").size(), 6U);
  const Changes told = shapes::changes_about(domain.report.changes, "triangles, at most");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(told[0].is_warning);
}

TEST(MixedBodies, ABallOfTrianglesOnACylinder) {
  const FacetSoup ball = faceted::ball_soup({1, 0.1, 1.1}, 0.5, 12);
  DomainOptions options;
  options.smallest_size = 0.1;
  const Domain domain = with_store(BRepPrimAPI_MakeCylinder(1, 2).Shape(), ball, options);
  checks::expect_watertight(domain.model);
  const Changes told = shapes::changes_about(domain.report.changes, "triangles, at most");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_GT(told[0].how_much, 0);
  EXPECT_LE(told[0].how_much, 0.01);
  // The parts overlap: less than both, more than either.
  const double cylinder = 2 * std::numbers::pi, own = faceted::volume_of(ball);
  EXPECT_GT(body_volume(domain.model), cylinder);
  EXPECT_LT(body_volume(domain.model), cylinder + 0.7 * own);
}

/// Cylinders turned by a ten-thousandth of a radian: the CAD library cannot triangulate what it makes of
/// them.
TEST(MixedBodies, BodiesOfCadThatItsLibraryCannotUniteAreUnitedAsTriangles) {
  const TopoDS_Shape first = BRepPrimAPI_MakeCylinder(1, 2).Shape();
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0.2, 0.3)), 1e-4);
  const TopoDS_Shape second = BRepBuilderAPI_Transform(first, turn, true).Shape();
  DomainOptions options;
  options.kind = DomainKind::body;
  const Domain domain = shapes::prepare(shapes::compound_of<TopoDS_Shape>({first, second}), options);
  checks::expect_watertight(domain.model);
  const Changes told = shapes::changes_about(domain.report.changes, "triangles, at most");
  ASSERT_EQ(told.size(), 2U);
  double deviation = 0;
  for (const Change& change : told) deviation = std::max(deviation, change.how_much);
  // One cylinder and a sliver of the other, but for what triangles are off them.
  EXPECT_NEAR(body_volume(domain.model), 2 * std::numbers::pi, 6 * std::numbers::pi * (deviation + 1e-4));
  EXPECT_EQ(shapes::changes_about(domain.report.changes, "that overlap are united").size(), 1U);
}

TEST(MixedBodies, WhatLiesInsideIsLeftOut) {
  const Domain inner = with_store(cad_box({0, 0, 0}, {1, 1, 1}), faceted::ball_soup({0.5, 0.5, 0.5}, 0.2, 8));
  EXPECT_NEAR(body_volume(inner.model), 1, 1e-7);
  const Domain outer =
      with_store(cad_box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), faceted::ball_soup({0, 0, 0}, 1, 8));
  EXPECT_NEAR(body_volume(outer.model), faceted::volume_of(faceted::ball_soup({0, 0, 0}, 1, 8)), 1e-7);
  for (const Domain* domain : {&inner, &outer})
    EXPECT_EQ(shapes::changes_about(domain->report.changes, "lie inside others").size(), 1U);
}

TEST(MixedBodies, BodiesThatNearlyTouchAreRefusedByName) {
  const std::string text = refusal_of_store(BRepPrimAPI_MakeCylinder(1, 2).Shape(),
                                            faceted::box_soup({1 + 1e-7, -1, -1}, {2, 1, 3}));
  for (const char* const word : {"'store'", "so near each other at (", "Remedy"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
}

TEST(MixedBodies, AHalfModelKeepsTrianglesOffItsPlane) {
  DomainOptions options;
  options.far_field = FarFieldOptions{.symmetry = Symmetry::y};
  const TopoDS_Shape half = cad_box({0, 0, 0}, {1, 1, 1});
  const Domain domain = with_store(half, faceted::ball_soup({0, 2, 0}, 0.5, 8), options);
  checks::expect_watertight(domain.model);
  EXPECT_FALSE(shapes::faces_of_patch(domain.model, "symmetry").empty());
  const std::string text = refusal_of_store(half, faceted::ball_soup({3, 0, 0}, 0.5, 8), options);
  EXPECT_NE(text.find("plane of symmetry"), std::string::npos) << text;
}

TEST(MixedBodies, TrailingEdgesCloseBesideTriangles) {
  const TopoDS_Shape wing = shapes::blunt_wing({{0, 0, 0.02}, {3, 0, 0.02}});
  const DomainOptions options = shapes::sharpened();
  const Model alone = shapes::prepare(wing, options).model;
  const Model model = with_store(wing, faceted::ball_soup({0, 1, 2}, 0.3, 8), options).model;
  checks::expect_watertight(model);
  EXPECT_EQ(model.face_count(), alone.face_count() + 1);
  const FaceId ball = model.face_count() - 1;
  ASSERT_TRUE(model.is_faceted(ball));
  EXPECT_EQ(model.patches()[model.face(ball).patch], "store");
  EXPECT_NEAR(model.face_area(ball), 4 * std::numbers::pi * 0.09, 0.1);
  EXPECT_EQ(Model::from_bytes(model.serialise()).serialise(), model.serialise());
}

TEST(MixedBodies, PartsStandBesideAFileOfTrianglesToo) {
  const real::TemporaryFile hull("hull.stl",
                                 faceted::ascii_stl(faceted::box_soup({0, 0, 0}, {2, 2, 2}), "hull")),
      store("store.stl", faceted::ascii_stl(faceted::box_soup({1, 1, 1}, {3, 3, 3}))),
      pod("pod.stl", faceted::ascii_stl(faceted::box_soup({5, 5, 5}, {6, 6, 6})));
  DomainOptions options;
  options.file = hull.path();
  options.parts = {{"store", store.path(), 1}, {"pod", pod.path(), 1}};
  const Domain domain = prepare_domain(options);
  checks::expect_watertight(domain.model);
  EXPECT_NEAR(body_volume(domain.model), 15 + 1, 1e-7);
  for (const char* const patch : {"hull", "store", "pod"})
    EXPECT_EQ(shapes::faces_of_patch(domain.model, patch).size(), 6U) << patch;
}

TEST(MixedBodies, AFileWithoutTrianglesIsNoPart) {
  const real::TemporaryFile file("store.step", "ISO-10303-21;");
  DomainOptions options;
  options.parts.push_back({"store", file.path(), 1});
  const std::string text = shapes::refusal(cad_box({0, 0, 0}, {1, 1, 1}), options);
  EXPECT_NE(text.find("no faceted file"), std::string::npos) << text;
}

}  // namespace
}  // namespace aeroloom::cad
