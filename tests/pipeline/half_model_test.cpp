// Half models: the plane of symmetry is planar to the last bit, whether the file ends there or the program
// cuts.
#include "tests/pipeline/cad_cases.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPPolyDataReader.h>

namespace aeroloom::pipeline {
namespace {

using cad::FarFieldShape;
using cad::Symmetry;
using cad_cases::Folder;

/// The different values of a coordinate over the triangles of a patch.
std::set<double> coordinates_of_patch(const std::string& file, const std::string& patch, int axis) {
  vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* surface = reader->GetOutput();
  auto* names = vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("patch_names"));
  vtkDataArray* patches = surface->GetCellData()->GetArray("patch");
  std::set<double> values;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell) {
    if (std::string(names->GetValue(static_cast<vtkIdType>(patches->GetTuple1(cell)))) != patch) continue;
    surface->GetCellPoints(cell, ids);
    for (vtkIdType k = 0; k < 3; ++k) values.insert(surface->GetPoint(ids->GetId(k))[axis]);
  }
  return values;
}

struct HalfModel {
  TopoDS_Shape body;
  FarFieldShape shape = FarFieldShape::hemisphere;
  Symmetry symmetry = Symmetry::automatic;
  int axis = 1;
  double position = 0;
  double fluid = 0;  ///< expected volume, to 2 %: the mesh has chords
  cad::Axis cylinder_axis = cad::Axis::x;
};

constexpr double extent = 3;

void expect_half(const HalfModel& half) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(half.body, "body.brep"), folder, 20000);
  cad::FarFieldOptions far_field;
  far_field.shape = half.shape;
  far_field.extent = extent;
  far_field.symmetry = half.symmetry;
  far_field.axis = half.cylinder_axis;
  if (half.position != 0) far_field.symmetry_position = half.position;
  input.domain.far_field = far_field;
  std::string alone;
  const report::RunRecord record = cad_cases::run_twice(input, alone);
  EXPECT_EQ(record.hash, alone);
  EXPECT_NEAR(record.mesh_volume, half.fluid, 0.02 * half.fluid);
  const std::set<double> values =
      coordinates_of_patch(input.output.directory + "/surface.pvtp", "symmetry", half.axis);
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(*values.begin(), half.position);
}

double half_sphere(double radius) {
  return 2 * std::numbers::pi / 3 * std::pow(radius, 3);
}

TEST(HalfModelLocal, SphereIsCutByTheProgram) {
  expect_half({.body = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape(),
               .symmetry = Symmetry::y,
               .fluid = half_sphere(2 * extent) - half_sphere(1)});
}

TEST(HalfModelLocal, SymmetricBodyNeedsNoAxis) {
  expect_half(
      {.body = BRepPrimAPI_MakeBox(gp_Pnt(0, -1, 0), 1, 2, 1).Shape(), .fluid = half_sphere(2 * extent) - 1});
}

TEST(HalfModelLocal, BoxEndsAtThePlane) {
  expect_half({.body = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 2, 1, 1).Shape(),
               .symmetry = Symmetry::z,
               .axis = 2,
               .fluid = half_sphere(2 * extent) - 2});
}

TEST(HalfModelLocal, HalfBoxAroundATiltedCut) {
  expect_half({.body = BRepPrimAPI_MakeSphere(gp_Pnt(0.5, 0, 0), 1).Shape(),
               .shape = FarFieldShape::box,
               .symmetry = Symmetry::x,
               .axis = 0,
               .position = 0.5,
               .fluid = std::pow(4 * extent, 3) / 2 - half_sphere(1)});
}

TEST(HalfModel, HalfCylinderAlongAndAcross) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape();
  const double far = std::numbers::pi * std::pow(2 * extent, 3);
  expect_half({.body = ball,
               .shape = FarFieldShape::cylinder,
               .symmetry = Symmetry::z,
               .axis = 2,
               .fluid = far - half_sphere(1)});
  expect_half({.body = ball,
               .shape = FarFieldShape::cylinder,
               .symmetry = Symmetry::y,
               .axis = 1,
               .fluid = far - half_sphere(1),
               .cylinder_axis = cad::Axis::y});
}

// Cut across the tube: two discs are two holes in the plane.
TEST(HalfModel, TorusLeavesTwoHoles) {
  const double torus = 2 * std::numbers::pi * std::numbers::pi * 1 * 0.3 * 0.3;
  expect_half({.body = BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1, 0.3).Shape(),
               .symmetry = Symmetry::y,
               .fluid = half_sphere(2.6 * extent) - torus / 2});
}

// An open tube that stands on the plane: the fluid inside reaches the plane on an island.
TEST(HalfModelLocal, TubeOnThePlaneKeepsTheFluidInside) {
  const gp_Ax2 up(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0));
  const TopoDS_Shape tube = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(up, 1, 2).Shape(),
                                            BRepPrimAPI_MakeCylinder(up, 0.6, 2).Shape())
                                .Shape();
  expect_half({.body = tube,
               .symmetry = Symmetry::y,
               .fluid = half_sphere(2 * extent) - 2 * std::numbers::pi * (1 - 0.36)});
}

// A hollow ball cut in two: its cavity is no part of the fluid outside.
TEST(HalfModel, CavityIsLeftOut) {
  const TopoDS_Shape shell = BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape(),
                                             BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 0.5).Shape())
                                 .Shape();
  expect_half({.body = shell, .symmetry = Symmetry::y, .fluid = half_sphere(2 * extent) - half_sphere(1)});
}

void expect_refused(const TopoDS_Shape& body, const cad::FarFieldOptions& far_field,
                    const std::string& words) {
  const Folder folder;
  cases::Case input = cad_cases::coarse_case(folder.write(body, "body.brep"), folder, 5000);
  input.domain.far_field = far_field;
  report::RunRecord record;
  try {
    run_case(parallel::Communicator::world(), input, record);
    ADD_FAILURE() << "meshed: " << words;
  } catch (const report::StageFailure& failure) {
    EXPECT_EQ(failure.code(), report::ExitCode::cad);
    EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
  }
}

TEST(HalfModel, ImpossibleOnesAreRefused) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(3, 3, 3), 1).Shape();
  expect_refused(ball, {.shape = FarFieldShape::hemisphere, .extent = 5}, "give farfield.symmetry");
  expect_refused(ball, {.shape = FarFieldShape::hemisphere, .extent = 5, .symmetry = Symmetry::none},
                 "a hemisphere is half a far field");
  expect_refused(ball,
                 {.shape = FarFieldShape::box, .extent = 5, .symmetry = Symmetry::y, .symmetry_position = 0},
                 "misses the body");
  expect_refused(
      ball,
      {.shape = FarFieldShape::hemisphere, .extent = 0.4, .symmetry = Symmetry::y, .symmetry_position = 3},
      "cuts the body");
}

}  // namespace
}  // namespace aeroloom::pipeline
