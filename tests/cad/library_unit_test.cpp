// Tiny and huge shapes: made in a unit of their own, told in the file's.
#include "cad/model/library_unit.hpp"

#include "cad/domain/domain.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/repair/diagnosis.hpp"
#include "tests/cad/cad_shapes.hpp"

#include <cmath>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BinTools.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

TopoDS_Shape times(const TopoDS_Shape& shape, double factor) {
  gp_Trsf scaling;
  scaling.SetScaleFactor(factor);
  return BRepBuilderAPI_Transform(shape, scaling, true).Shape();
}

/// A block with a hole and a countersink, 1.5 long.
TopoDS_Shape countersunk() {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(1.5, 0.8, 0.5).Shape();
  const gp_Ax2 axis(gp_Pnt(0.6, 0.4, -0.1), gp_Dir(0, 0, 1)), top(gp_Pnt(0.6, 0.4, 0.3), gp_Dir(0, 0, 1));
  const TopoDS_Shape hole = BRepPrimAPI_MakeCylinder(axis, 0.1, 1).Shape();
  return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(block, hole).Shape(),
                         BRepPrimAPI_MakeCone(top, 0.1, 0.3, 0.2).Shape())
      .Shape();
}

/// By way of a binary file, which has all digits.
Domain prepare_exactly(const TopoDS_Shape& shape, DomainOptions options) {
  const real::TemporaryFile file("exact.brep", "");
  BinTools::Write(shape, file.path().c_str());
  options.file = file.path();
  return prepare_domain(options);
}

Model fluid_of(const TopoDS_Shape& shape) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  return prepare_exactly(shape, options).model;
}

void expect_scaled(const Model& one, const Model& other, int power) {
  const auto times_power = [&](Vec3 p) {
    return Vec3{std::ldexp(p.x, power), std::ldexp(p.y, power), std::ldexp(p.z, power)};
  };
  ASSERT_EQ(one.face_count(), other.face_count());
  ASSERT_EQ(one.vertex_count(), other.vertex_count());
  for (VertexId v = 0; v < one.vertex_count(); ++v) EXPECT_EQ(times_power(one.vertex(v)), other.vertex(v));
  for (FaceId f = 0; f < one.face_count(); ++f) {
    EXPECT_EQ(std::ldexp(one.face_area(f), 2 * power), other.face_area(f));
    EXPECT_EQ(times_power(one.face_place(f).box.high), other.face_place(f).box.high);
    const Facets facets = one.facets(f, 0.01, 0.3), scaled = other.facets(f, std::ldexp(0.01, power), 0.3);
    ASSERT_EQ(facets.triangles, scaled.triangles);
    for (std::size_t p = 0; p < facets.points.size(); ++p)
      ASSERT_EQ(times_power(facets.points[p]), scaled.points[p]);
    // Parameters are those of the shape in its unit.
    const Vec2 uv = scaled.uv[scaled.triangles.front()[0]];
    const Vec3 at = other.face_point(f, uv);
    EXPECT_EQ(other.project(f, at, uv).converged, true);
    EXPECT_NEAR(distance(other.project(f, at, uv).point, at), 0, std::ldexp(1e-9, power));
    EXPECT_EQ(std::ldexp(other.face_curvatures(f, uv).largest, power),
              one.face_curvatures(f, facets.uv[facets.triangles.front()[0]]).largest);
  }
  EXPECT_EQ(std::ldexp(one.region_volume(0), 3 * power), other.region_volume(0));
  EXPECT_EQ(times_power(one.bounds().high), other.bounds().high);
}

TEST(LibraryUnit, IsOneForUsualExtentsAndAPowerOfTwoElsewhere) {
  for (const double extent : {0.02, 1.0, 100.0, 60000.0, 1e6}) EXPECT_EQ(library_unit(extent), 1) << extent;
  for (const double extent : {1e-9, 1e-4, 1e8, 3e12}) {
    const double unit = library_unit(extent);
    EXPECT_EQ(unit, std::ldexp(1.0, std::ilogb(unit)));
    EXPECT_GE(extent / unit, 1);
    EXPECT_LT(extent / unit, 2);
  }
  for (const double none : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_EQ(library_unit(none), 1);
}

TEST(LibraryUnit, AScaledModelHasTheSameDigits) {
  const TopoDS_Shape shape = countersunk();
  const Model one = fluid_of(times(shape, 1));
  for (const int power : {-30, -13, 30}) {
    SCOPED_TRACE(power);
    const Model other = fluid_of(times(shape, std::ldexp(1.0, power)));
    expect_scaled(one, other, power);
    expect_scaled(one, Model::from_bytes(other.serialise()), power);
  }
}

TEST(LibraryUnit, ExportedStepFilesAreReadBack) {
  for (const double factor : {1e-9, 1e-6, 1e9}) {
    SCOPED_TRACE(factor);
    const real::TemporaryFile brep("tiny.brep", ""), step("tiny.step", "");
    BRepTools::Write(times(countersunk(), factor), brep.path().c_str());
    DomainOptions options;
    options.kind = DomainKind::fluid;
    options.file = brep.path();
    export_step(options, ExportedShape::domain, step.path());
    options.file = step.path();
    const Domain domain = prepare_domain(options);
    EXPECT_NEAR(domain.report.reference_length, 1.5 * factor, 1e-9 * factor);
    const double volume = shapes::prepare_fluid(times(countersunk(), 1)).model.region_volume(0);
    EXPECT_NEAR(domain.model.region_volume(0), std::pow(factor, 3) * volume, 1e-6 * std::pow(factor, 3));
  }
}

TEST(LibraryUnit, WhatIsSaidIsInTheUnitOfTheFile) {
  constexpr double factor = 1e-9;
  const TopoDS_Shape block = times(BRepPrimAPI_MakeBox(1.5, 0.8, 0.5).Shape(), factor);
  const TopoDS_Shape open = shapes::compound_of(
      shapes::without(shapes::loose_faces(BRepPrimAPI_MakeBox(1.5, 0.8, 0.5).Shape()),
                      {{0.75, 0.4, 0.5}, {0.75, 0.4, 0}, {0, 0.4, 0.25}, {1.5, 0.4, 0.25}}));
  const std::string refusal = shapes::refusal(times(open, factor));
  EXPECT_NE(refusal.find("e-10"), std::string::npos) << refusal;
  const real::TemporaryFile file("tiny.brep", "");
  BRepTools::Write(block, file.path().c_str());
  const CadFacts facts = look_at_cad_file(file.path());
  EXPECT_DOUBLE_EQ(facts.bounds.high.x, 1.5 * factor);
  EXPECT_NEAR(facts.face_table.front().place.area, 0.4 * factor * factor, 1e-9 * factor * factor);
  DomainOptions options;
  options.file = file.path();
  const Diagnosis found = diagnose(options);
  EXPECT_DOUBLE_EQ(found.bounds.high.y, 0.8 * factor);
  ASSERT_TRUE(found.domain.has_value()) << found.failure;
}

TEST(LibraryUnit, LengthsOfOptionsScaleToo) {
  const auto half_of = [](double factor) {
    DomainOptions options;
    options.far_field.emplace();
    options.far_field->shape = FarFieldShape::hemisphere;
    options.far_field->extent = 10;
    options.far_field->unit = ExtentUnit::model;
    options.far_field->unit_length = factor;
    options.far_field->symmetry = Symmetry::y;
    options.far_field->symmetry_position = 0.1 * factor;
    options.smallest_size = 0.1 * factor;
    return prepare_exactly(times(BRepPrimAPI_MakeSphere(0.75).Shape(), factor), options);
  };
  const Domain one = half_of(1), tiny = half_of(std::ldexp(1.0, -30));
  EXPECT_EQ(std::ldexp(one.model.bounds().high.y, -30), tiny.model.bounds().high.y);
  EXPECT_EQ(std::ldexp(one.model.body_bounds().low.y, -30), tiny.model.body_bounds().low.y);
  ASSERT_EQ(one.report.changes.size(), tiny.report.changes.size());
  for (const Change& change : tiny.report.changes) {
    if (!change.where) continue;
    EXPECT_LT(norm(*change.where), 1e-8) << describe(change);
  }
}

std::string refusal_of(const TopoDS_Shape& shape) {
  try {
    fluid_of(shape);
  } catch (const CadError& error) {
    return error.what();
  }
  return "";
}

TEST(LibraryUnit, CoordinatesThatCannotBeCalculatedWithAreRefused) {
  EXPECT_EQ(refusal_of(BRepPrimAPI_MakeBox(1e29, 1e29, 1e29).Shape()), "");
  for (const double side : {1e31, 3e38}) {
    const std::string text = refusal_of(BRepPrimAPI_MakeBox(side, side, side).Shape());
    EXPECT_NE(text.find("the largest coordinate is"), std::string::npos) << text;
    EXPECT_NE(text.find("Remedy: write the file in another unit"), std::string::npos) << text;
  }
}

TEST(LibraryUnit, CornersThatNumbersDoNotTellApartAreRefused) {
  // Numbers are 2 apart there.
  const std::string text = refusal_of(BRepPrimAPI_MakeBox(gp_Pnt(1e16, 0, 0), 100, 100, 100).Shape());
  EXPECT_NE(text.find("all corners lie within 100 around"), std::string::npos) << text;
}

}  // namespace
}  // namespace aeroloom::cad
