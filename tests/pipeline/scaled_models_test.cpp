// Tiny and huge models: the mesh is that of the model of about one unit, scaled.
#include "tests/pipeline/cad_cases.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BinTools.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>

namespace aeroloom::pipeline {
namespace {

using cad_cases::Folder;

/// A block with a hole, 1.5 long, times a factor.
TopoDS_Shape drilled_block(double factor) {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(1.5, 0.8, 0.5).Shape();
  const gp_Ax2 axis(gp_Pnt(0.6, 0.4, -0.1), gp_Dir(0, 0, 1));
  const TopoDS_Shape drilled = BRepAlgoAPI_Cut(block, BRepPrimAPI_MakeCylinder(axis, 0.2, 1).Shape()).Shape();
  gp_Trsf scaling;
  scaling.SetScaleFactor(factor);
  return BRepBuilderAPI_Transform(drilled, scaling, true).Shape();
}

struct ScaledRun {
  report::RunRecord record;
  std::vector<double> coordinates;  // on rank 0, in the order of the file
};

std::vector<double> coordinates_in(const std::string& file) {
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkDataArray* const points = reader->GetOutput()->GetPoints()->GetData();
  std::vector<double> coordinates;
  for (vtkIdType p = 0; p < points->GetNumberOfTuples(); ++p)
    for (int axis = 0; axis < 3; ++axis) coordinates.push_back(points->GetComponent(p, axis));
  return coordinates;
}

ScaledRun mesh_block(double factor, const char* kind) {
  const Folder folder;
  const auto world = parallel::Communicator::world();
  const std::string file = folder.path() + "/block.brep";
  if (world.is_root()) BinTools::Write(drilled_block(factor), file.c_str());  // all digits
  world.barrier();
  cases::Case input = cad_cases::coarse_case(file, folder, 0);
  input.sizing.target_tetrahedra.reset();
  input.sizing.minimum = 0.0625 * factor;
  input.sizing.maximum = (kind == std::string("fluid") ? 0.25 : 1) * factor;
  if (kind == std::string("fluid")) {
    input.domain.kind = cad::DomainKind::fluid;
  } else {
    input.domain.far_field.emplace().extent = 4;
    input.domain.far_field->unit = cad::ExtentUnit::model;
    input.domain.far_field->unit_length = factor;
  }
  ScaledRun result;
  run_case(world, input, result.record);
  if (world.is_root()) result.coordinates = coordinates_in(input.output.directory + "/mesh.pvtu");
  return result;
}

/// The same numbers but for their exponents.
void expect_same_bits(const ScaledRun& one, const ScaledRun& other, int power) {
  ASSERT_EQ(one.coordinates.size(), other.coordinates.size());
  for (std::size_t i = 0; i < one.coordinates.size(); ++i)
    ASSERT_EQ(std::ldexp(one.coordinates[i], power), other.coordinates[i]) << i;
  EXPECT_EQ(one.record.quality->worst.front().value, other.record.quality->worst.front().value);
}

TEST(ScaledModels, PowersOfTwoChangeExponentsAlone) {
  const ScaledRun one = mesh_block(1, "fluid");
  for (const int power : {-30, -13, 30}) {
    SCOPED_TRACE(power);
    expect_same_bits(one, mesh_block(std::ldexp(1.0, power), "fluid"), power);
  }
}

TEST(ScaledModels, SoInAFarField) {
  const ScaledRun one = mesh_block(1, "body");
  expect_same_bits(one, mesh_block(std::ldexp(1.0, -30), "body"), -30);
}

TEST(ScaledModels, PowersOfTenChangeCountsLittle) {
  const ScaledRun one = mesh_block(1, "fluid");
  const auto count = static_cast<double>(one.record.counts.cells);
  for (const double factor : {1e-9, 1e9}) {
    const ScaledRun scaled = mesh_block(factor, "fluid");
    EXPECT_NEAR(static_cast<double>(scaled.record.counts.cells), count, 0.02 * count) << factor;
    EXPECT_NEAR(scaled.record.mesh_volume, std::pow(factor, 3) * one.record.mesh_volume,
                1e-4 * scaled.record.mesh_volume);
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
