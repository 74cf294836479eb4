// What stages say when they end, where something is to be warned of.
#include "pipeline/stage_log.hpp"

#include "parallel/observation/log.hpp"
#include "parallel/observation/warnings.hpp"

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

class StageLog : public testing::Test {
protected:
  void SetUp() override { parallel::configure_log(world, parallel::LogLevel::normal); }
  void TearDown() override {
    parallel::configure_log(world, parallel::LogLevel::quiet);
    parallel::take_warnings(world);
  }
  struct Said {
    std::string facts, warnings;
  };
  static Said said_by(const std::function<void()>& work) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    work();
    Said said;
    said.facts = testing::internal::GetCapturedStdout();
    said.warnings = testing::internal::GetCapturedStderr();
    return said;
  }
  const parallel::Communicator world = parallel::Communicator::world();
};

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

TEST_F(StageLog, WarnsWhereMoreTetrahedraComeThanWereForecast) {
  EXPECT_EQ(said_by([&] { warn_of_count(1.4e6, 1e6, 0); }).warnings, "");
  const Said faces = said_by([&] { warn_of_count(3e6, 1e6, 0); });
  EXPECT_TRUE(has(faces.warnings, "3 times the 1e+06")) << faces.warnings;
  EXPECT_TRUE(has(faces.warnings, "faces have more triangles than sizes ask for")) << faces.warnings;
  EXPECT_TRUE(has(said_by([&] { warn_of_count(3e6, 1e6, 2); }).warnings, "sizes fell in 2 round(s)"));
}

TEST_F(StageLog, WarnsOfLengthsThatAreNoMetresWhereSolversExpectThem) {
  cases::OutputOptions output;
  output.formats = {io::FileFormat::vtu};
  EXPECT_EQ(said_by([&] { warn_of_units("mm", 1e-3, output); }).warnings, "");
  output.formats = {io::FileFormat::su2, io::FileFormat::cgns};
  EXPECT_TRUE(has(said_by([&] { warn_of_units("mm", 1e-3, output); }).warnings,
                  "lengths stay in mm, and solvers take those of su2, cgns for metres. Remedy: scale the "
                  "mesh by 0.001"));
  output.formats.push_back(io::FileFormat::openfoam);
  const Said said = said_by([&] { warn_of_units("in", 0.0254, output); });
  EXPECT_TRUE(has(said.warnings, "su2, cgns, openfoam for metres")) << said.warnings;
  EXPECT_TRUE(has(said.warnings, "transformPoints -scale '(0.0254 0.0254 0.0254)'")) << said.warnings;
  EXPECT_EQ(said_by([&] { warn_of_units("m", 1, output); }).warnings, "");
  EXPECT_EQ(said_by([&] { warn_of_units("", 1, output); }).warnings, "");
}

TEST_F(StageLog, WarnsOfAYPlusThatIsNotWhereTheSolverHasIt) {
  cases::Case input;
  input.layers.given = true, input.layers.reynolds = 1e6, input.layers.length = 1;
  input.output.formats = {io::FileFormat::vtu, io::FileFormat::su2};
  EXPECT_EQ(said_by([&] { warn_of_solver_points(input); }).warnings, "");
  input.output.formats.push_back(io::FileFormat::openfoam);
  EXPECT_TRUE(has(said_by([&] { warn_of_solver_points(input); }).warnings, "Remedy: sizing.solver: cell"));
  input.sizing.solver = sizing::SolverPoints::cell;
  EXPECT_EQ(said_by([&] { warn_of_solver_points(input); }).warnings, "");
  input.sizing.solver = sizing::SolverPoints::vertex;
  input.layers.reynolds.reset(), input.layers.first = 1e-5;
  EXPECT_EQ(said_by([&] { warn_of_solver_points(input); }).warnings, "") << "a height is a height";
}

// What a user should act on: two elements around an edge, or much of the body. Else it is a fact.
TEST_F(StageLog, WarnsOfShapesThatAreLost) {
  sizing::SizingOptions sizes;
  sizes.minimum = 0.06, sizes.curvature_angle = 12;
  EXPECT_EQ(domain::warning_of({{"wing", 0.04, 40, 0.01}}, sizes), "");
  EXPECT_EQ(domain::warning_of({{"wing", 0.001, 180, 0.0001}}, sizes), "");
  EXPECT_NE(domain::warning_of({{"wing", 0.9, 30, 0.5}}, sizes), "");
  const std::string text = domain::warning_of({{"tail", 0.1, 95, 0.01}, {"wing", 0.04, 180, 0.01}}, sizes);
  EXPECT_EQ(text.find("elements turn by 180 degrees and more, most on 'wing'"), 0u) << text;
  EXPECT_TRUE(has(text, "2 % of the body. Remedy: a smaller sizing.minimum")) << text;
  EXPECT_LT(text.size(), 400u);
}

TEST_F(StageLog, WarnsOfWallsThatLoseTheirArea) {
  std::vector<report::PatchRow> patches(2);
  patches[0] = {.name = "far", .type = mesh::PatchType::farfield, .area = 90, .cad_area = 100};
  patches[1] = {.name = "wing", .area = 98.1, .cad_area = 100};
  EXPECT_EQ(said_by([&] { warn_of_lost_area(patches); }).warnings, "");
  patches[1].area = 97.5;
  patches.push_back({.name = "rail", .area = 91.6, .cad_area = 100});
  const Said said = said_by([&] { warn_of_lost_area(patches); });
  EXPECT_TRUE(has(said.warnings, "the area of 'rail' (-8.4 %), 'wing' (-2.5 %) differs")) << said.warnings;
}

TEST_F(StageLog, WarnsOfPoorCells) {
  report::VolumeFigures figures;
  figures.quality.emplace();
  figures.quality->worst = {{12, 7, {}}};
  EXPECT_EQ(said_by([&] { warn_of_flaws(figures); }).warnings, "");
  figures.quality->worst = {{0.5, 7, {1, 2, 3}}};
  const Said thin = said_by([&] { warn_of_flaws(figures); });
  EXPECT_TRUE(has(thin.warnings, "an angle of 0.5 degrees (cell 7 of the tetrahedra, at (1, 2, 3))"))
      << thin.warnings;
  mesh::MixedQuality& cells = figures.cells.emplace();
  cells.places.of[2] = {{11120,
                         mesh::severity_of(mesh::Flaw::size_jump, 11120),
                         3,
                         mesh::CellShape::prism,
                         mesh::Flaw::size_jump,
                         {}}};
  const Said jump = said_by([&] { warn_of_flaws(figures); });
  EXPECT_TRUE(has(jump.warnings, "a neighbour 11120 times as large (cell 3 of the prisms")) << jump.warnings;
  EXPECT_FALSE(has(jump.warnings, "degrees")) << jump.warnings;
}

TEST_F(StageLog, SaysWhatSolversMakeOfTheMesh) {
  report::VolumeFigures figures;
  mesh::SolverQuality& solver = figures.solver.emplace();
  solver.cells = 20;
  solver.inner_faces = 31;
  solver.largest_non_orthogonality = 86.04;
  solver.average_non_orthogonality = 12.5;
  solver.non_orthogonal_faces = 2;
  solver.largest_skewness = 3.5;
  const Said said = said_by([&] { log_solver_quality(solver); });
  EXPECT_TRUE(
      has(said.facts, "non-orthogonality 86.04 degrees at most, 12.5 on average, 2 of 31 faces above 70"))
      << said.facts;
  EXPECT_TRUE(has(said.facts, "skewness 3.5 at most, 0 faces above 4")) << said.facts;
  EXPECT_TRUE(has(said.facts, "0 of 20 cells above 1000")) << said.facts;
  solver.worst[static_cast<std::size_t>(mesh::SolverMeasure::non_orthogonality)] = {
      {86.04, 9, mesh::CellShape::tetrahedron, {1, 2, 3}}};
  solver.worst[static_cast<std::size_t>(mesh::SolverMeasure::skewness)] = {
      {3.5, 9, mesh::CellShape::tetrahedron, {1, 2, 3}}};
  const Said face = said_by([&] { warn_of_flaws(figures); });
  EXPECT_TRUE(has(face.warnings,
                  "a face with a non-orthogonality of 86 degrees (cell 9 of the tetrahedra, at (1, 2, 3))"))
      << face.warnings;
  EXPECT_FALSE(has(face.warnings, "skewness")) << face.warnings;
}

TEST_F(StageLog, TellsNeedlesThatTheCadForcesFromThoseOfTheMesh) {
  surface::SurfaceReport report;
  const std::vector<report::FaceRow> faces{{.name = "wing"}, {.name = "body"}};
  EXPECT_EQ(said_by([&] { log_needles(report, faces); }).facts, "");
  surface::NeedleGroup forced, own;
  forced.cause = surface::NeedleCause::corner;
  forced.needles = 3;
  forced.degrees = 2.5;
  own.cause = surface::NeedleCause::mesh;
  own.needles = 4;
  own.degrees = 7;
  own.face = 1;
  report.needles = {forced, own};
  const Said said = said_by([&] { log_needles(report, faces); });
  EXPECT_TRUE(has(said.facts, "3 triangles below 10 degrees")) << said.facts;
  EXPECT_TRUE(has(said.facts, "in 1 places, from 2.5 degrees")) << said.facts;
  EXPECT_TRUE(
      has(said.warnings,
          "4 triangles in 1 place(s) are below 10 degrees that the CAD does not force, the least 7 on "
          "'body' at (0, 0, 0). Remedy"))
      << said.warnings;
  report.needles.assign(7, own);
  const Said many = said_by([&] { log_needles(report, faces); });
  EXPECT_TRUE(has(many.warnings, "28 triangles in 7 place(s)") && has(many.warnings, "surface.needles[]"))
      << many.warnings;
}

TEST_F(StageLog, SaysNothingOfPinnedElementsWhereThereAreNone) {
  attribution::PinnedReport report;
  EXPECT_EQ(said_by([&] { log_pinned(report); }).facts, "");
  report.tetrahedra = 5;
  report.pinned = {.tetrahedra = 5, .smallest_angle = 3};
  const Said said = said_by([&] { log_pinned(report); });
  EXPECT_TRUE(has(said.facts, "5 (from 3 degrees) are pinned by 0 sharp places")) << said.facts;
}

TEST_F(StageLog, WarnsOfLayersBelowTheBoundaryLayer) {
  report::LayerRecord record;
  record.asked.patches = {{.first = 1e-3, .growth = 1.2, .constant = 1, .count = 10, .total = 0}, {}};
  record.report.patches.resize(2);
  layers::PatchLayers& made = record.report.patches[0];
  made.area = 2, made.sums.heights = 2 * 0.026, made.sums.edges = 2;
  record.boundary_layer = 0.02;
  const Said high = said_by([&] { warn_of_low_layers(record, {"wing", "far"}); });
  EXPECT_TRUE(has(high.warnings, "layers: on 'wing' 10 layers end at 0.026")) << high.warnings;
  EXPECT_TRUE(has(high.warnings, "Remedy: layers.fit: growth or count,")) << high.warnings;
  EXPECT_FALSE(has(high.warnings, "boundary layer")) << high.warnings;
  record.fit = cases::LayerFit::growth;
  const Said fitted = said_by([&] { warn_of_low_layers(record, {"wing", "far"}); });
  EXPECT_TRUE(has(fitted.warnings, "Remedy: layers.fit: count,")) << fitted.warnings;
  record.asked.patches[0].count = 0;
  record.boundary_layer = 0.025;
  const Said low = said_by([&] { warn_of_low_layers(record, {"wing", "far"}); });
  EXPECT_TRUE(has(low.warnings, "layers: on 'wing' layers are 0.026 high on average, where a boundary layer"))
      << low.warnings;
  EXPECT_FALSE(has(low.warnings, "layers end")) << low.warnings;
  const Said facts = said_by([&] { log_layers(record); });
  EXPECT_TRUE(has(facts.facts, "together 0.026 high; the boundary layer of a flat plate is 0.025"))
      << facts.facts;
}

}  // namespace
}  // namespace aeroloom::pipeline
