// Tori whose tube is wider than their ring: the outer part is the body.
#include "cad/repair/spindle_tori.hpp"

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/real_files.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Ax3.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double pi = std::numbers::pi, ring = 0.5, tube = 1;

/// All of the tube, as the CAD library reads a DEGENERATE_TOROIDAL_SURFACE.
TopoDS_Solid whole_tube() {
  const Handle(Geom_ToroidalSurface) torus = new Geom_ToroidalSurface(gp_Ax3(), ring, tube);
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  builder.Add(shell, BRepBuilderAPI_MakeFace(torus, 0, 2 * pi, 0, 2 * pi, 1e-7).Face());
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

/// The part of the disk beyond the axis, turned around it.
double volume_of_apple(double ring, double tube) {
  const double half_width = std::sqrt(tube * tube - ring * ring);
  const double area = tube * tube / 2 * (pi / 2 + std::asin(ring / tube)) + ring / 2 * half_width;
  return 4 * pi * (ring * area + std::pow(half_width, 3) / 3);
}

void expect_apple(const TopoDS_Shape& shape, Vec3 centre) {
  const Domain domain = shapes::prepare_fluid(shape);
  EXPECT_NEAR(domain.model.region_volume(0), volume_of_apple(ring, tube), 1e-3 * volume_of_apple(ring, tube));
  EXPECT_EQ(domain.model.face_count(), 1);
  EXPECT_EQ(domain.model.face(0).number, 0);
  EXPECT_EQ(shapes::changes_about(domain.report.changes, "its outer part was kept").size(), 1u);
  // Nothing is left around the middle.
  for (const Vec3 p : domain.model.facets(0, 0.01, 0.3).points)
    EXPECT_GT(distance(p, centre), 0.99 * std::sqrt(tube * tube - ring * ring));
}

TEST(SpindleTori, AreTheirOuterPart) {
  expect_apple(whole_tube(), {0, 0, 0});
  expect_apple(whole_tube().Reversed(), {0, 0, 0});
}

TEST(SpindleTori, AreTheirOuterPartWhereTheyArePlaced) {
  gp_Trsf move;
  move.SetTranslation(gp_Vec(3, -2, 5));
  expect_apple(whole_tube().Moved(TopLoc_Location(move)), {3, -2, 5});
}

// A hole from side to side is kept: such a face is left as it is.
TEST(SpindleTori, WithBordersStay) {
  const Handle(Geom_ToroidalSurface) torus = new Geom_ToroidalSurface(gp_Ax3(), ring, tube);
  NamedShape half;
  half.shape = BRepBuilderAPI_MakeFace(torus, 0, pi, 0, 2 * pi, 1e-7).Face();
  Changes changes;
  trim_spindle_tori(half, changes);
  EXPECT_TRUE(changes.empty());
}

// STEP says which part is meant.
TEST(SpindleTori, OfStepAreOuterOrRefused) {
  const std::string name = "reported/apple_torus.step";
  if (!real::has(name)) GTEST_SKIP() << "no shared geometry";
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.file = real::file(name);
  EXPECT_NEAR(prepare_domain(options).model.region_volume(0), volume_of_apple(50, 100),
              1e-3 * volume_of_apple(50, 100));
  std::string text = real::read(name);
  const std::string outer = ",#11,50.,100.,.T.";
  const std::size_t at = text.find(outer);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, outer.size(), ",#11,50.,100.,.F.");
  const real::TemporaryFile lemon("lemon.step", text);
  options.file = lemon.path();
  try {
    prepare_domain(options);
    ADD_FAILURE() << "the inner part was taken for the outer one";
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find("inner part of a torus"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::cad
