// Solids within others: in cavities they are regions, in the open they are bodies.
#include "tests/cad/cad_shapes.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <TopoDS_Shape.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

TopoDS_Shape ball(double radius) {
  return BRepPrimAPI_MakeSphere(radius).Shape();
}

/// A cube of edge 6 about the origin, with a round cavity of radius 2.
TopoDS_Shape hollow_cube() {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-3, -3, -3), 6, 6, 6).Shape(), ball(2)).Shape();
}

Domain prepare_both(const TopoDS_Shape& first, const TopoDS_Shape& second) {
  return shapes::prepare(shapes::compound_of<TopoDS_Shape>({first, second}));
}

TEST(NestedSolids, WhatLiesLooseInACavityIsARegion) {
  const Domain domain = prepare_both(ball(1), hollow_cube());
  EXPECT_EQ(domain.report.kind, DomainKind::fluid) << domain.report.reason;
  EXPECT_NE(domain.report.reason.find("1 of its 2 solids lie in cavities"), std::string::npos);
  ASSERT_EQ(domain.model.region_count(), 2);
  EXPECT_EQ(domain.model.face_count(), 6 + 1 + 1);
}

TEST(NestedSolids, WhatFillsACavityIsARegionWithAnInterface) {
  const Domain domain = prepare_both(hollow_cube(), ball(2));
  EXPECT_EQ(domain.report.kind, DomainKind::fluid) << domain.report.reason;
  ASSERT_EQ(domain.model.region_count(), 2);
  EXPECT_EQ(domain.model.face_count(), 6 + 1);
}

TEST(NestedSolids, WhatLiesInTheMaterialOfABodyIsNoRegion) {
  const TopoDS_Shape angle = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-3, -3, -3), 16, 6, 16).Shape(),
                                             BRepPrimAPI_MakeBox(gp_Pnt(3, -3, 3), 10, 6, 10).Shape())
                                 .Shape();
  const Domain domain = prepare_both(ball(1), angle);
  EXPECT_EQ(domain.report.kind, DomainKind::body) << domain.report.reason;
}

/// Openings that decide lie on the hull, as ends of a duct do, and not in it, as those of engines do.
TEST(NestedSolids, AnInletAndAnOutletOnTheHullAreThoseOfADuct) {
  const TopoDS_Shape bar = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 6, 1, 1).Shape();
  const TopoDS_Shape recessed =
      BRepAlgoAPI_Cut(bar, BRepPrimAPI_MakeBox(gp_Pnt(-1, 0.05, 0.05), 3, 0.9, 0.9).Shape()).Shape();
  const auto kind_of = [](const TopoDS_Shape& shape, const OpeningNames& openings) {
    DomainOptions options;
    options.openings = openings;
    return shapes::prepare(shape, options).report.kind;
  };
  EXPECT_EQ(kind_of(bar, {{"xmin"}, {"xmax"}}), DomainKind::fluid);
  EXPECT_EQ(kind_of(bar, {{"xmin"}, {}}), DomainKind::body);
  EXPECT_EQ(kind_of(bar, {{"xmin"}, {"no_such_face"}}), DomainKind::body);
  EXPECT_EQ(kind_of(recessed, {{"body"}, {"xmax"}}), DomainKind::body) << "the recess is deep in the hull";
}

/// A ball in a cage of large tolerances, where the classifier is wrong about one of the ball's poles.
TEST(NestedSolids, ABallInAnOpenCageMeetsTheFluid) {
  const std::string name = "parts/axom_boxed_sphere.step";
  if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
  DomainOptions options;
  options.file = real::file(name);
  const Domain domain = prepare_domain(options);
  EXPECT_EQ(domain.report.kind, DomainKind::body) << domain.report.reason;
  EXPECT_TRUE(shapes::changes_about(domain.report.changes, "do not reach the fluid").empty());
  EXPECT_FALSE(shapes::faces_of_patch(domain.model, "sphere").empty());
  EXPECT_FALSE(shapes::faces_of_patch(domain.model, "box").empty());
}

}  // namespace
}  // namespace aeroloom::cad
