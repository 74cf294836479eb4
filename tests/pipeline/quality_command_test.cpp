// The command quality and its limits on cells, on a stack of prisms beside a cube of tetrahedra.
#include "tests/pipeline/command_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;

/// Layers of prisms, 1, 2 and 4 high, over a unit square; elsewhere a cube of six tetrahedra, every other one
/// turned over.
std::string stack_of_prisms() {
  std::ostringstream text;
  text << "MeshVersionFormatted 2\nDimension 3\nVertices\n24\n";
  for (const int z : {0, 1, 3, 7})
    for (const int y : {0, 1})
      for (const int x : {0, 1}) text << x << " " << y << " " << z << " 0\n";
  for (const int z : {0, 1})
    for (const int y : {0, 1})
      for (const int x : {0, 1}) text << 5 + x << " " << y << " " << z << " 0\n";
  text << "Quadrilaterals\n1\n1 2 6 5 4\nTriangles\n2\n1 2 4 3\n1 4 3 3\nPrisms\n6\n";
  for (int k = 0; k < 3; ++k) {
    for (const std::array<int, 3>& corners : {std::array{1, 2, 4}, std::array{1, 4, 3}}) {
      for (const int above : {0, 4})
        for (const int corner : corners) text << 4 * k + above + corner << " ";
      text << "1\n";
    }
  }
  text << "Tetrahedra\n6\n";
  std::array<int, 3> steps{1, 2, 4};
  do {
    constexpr int first = 17;
    text << first << " " << first + steps[0] << " " << first + steps[0] + steps[1] << " " << first + 7
         << " 2\n";
  } while (std::next_permutation(steps.begin(), steps.end()));
  text << "End\n";
  return text.str();
}

constexpr const char* names =
    "prisms 1 layers\ntetrahedra 2 cube\ntriangles 3 the wall wall\n"
    "quadrilaterals 4 plane / y = 0 symmetry\n";

Json row_of(const Json& rows, const std::string& name) {
  for (const Json& row : rows)
    if (row["name"] == name) return row;
  ADD_FAILURE() << "no " << name << " in " << rows;
  return {};
}

void expect_near(const Json& found, double wanted) {
  ASSERT_TRUE(found.is_number()) << found;
  EXPECT_NEAR(found.get<double>(), wanted, 1e-9);
}

class QualityCommand : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("stack.mesh", stack_of_prisms());
    write("stack.names", names);
  }
};

void expect_counts(const Json& report) {
  EXPECT_EQ(report["mesh"]["prisms"], 6);
  EXPECT_EQ(report["mesh"]["tetrahedra"], 6);
  EXPECT_EQ(report["mesh"]["pyramids"], 0);
  EXPECT_NEAR(report["mesh"]["volume"].get<double>(), 8, 1e-12);
  ASSERT_EQ(report["regions"].size(), 2u);
  EXPECT_EQ(report["regions"][0]["name"], "layers");
  EXPECT_EQ(report["regions"][1]["name"], "cube");
  expect_near(report["regions"][0]["volume"], 7);
  expect_near(report["regions"][1]["volume"], 1);
  const Json wall = row_of(report["patches"], "the wall"), plane = row_of(report["patches"], "plane / y = 0");
  EXPECT_EQ(wall["triangles"], 2);
  EXPECT_NEAR(wall["area"].get<double>(), 1, 1e-12);
  EXPECT_EQ(plane["type"], "symmetry");
  EXPECT_EQ(plane["quadrilaterals"], 1);
  EXPECT_EQ(report["reading"]["turned_cells"], 3);
  EXPECT_GT(report["reading"]["unnamed_faces"], 0);
  for (const Json& count : report["defects"]) EXPECT_EQ(count, 0) << report["defects"];
}

void expect_qualities(const Json& quality) {
  const Json prisms = quality["prisms"], tetrahedra = quality["tetrahedra"];
  expect_near(prisms["volume_ratio"]["maximum"], 2);
  expect_near(prisms["volume_ratio"]["minimum"], 2);  // the larger of all neighbours
  expect_near(prisms["edge_ratio"]["maximum"], 4);
  expect_near(prisms["scaled_jacobian"]["minimum"], std::sqrt(2.0 / 3));
  expect_near(prisms["min_dihedral_deg"]["minimum"], 45);
  EXPECT_FALSE(prisms.contains("mean_ratio"));
  expect_near(tetrahedra["max_dihedral_deg"]["maximum"], 90);
  EXPECT_FALSE(tetrahedra.contains("scaled_jacobian"));
  expect_near(tetrahedra["volume_ratio"]["maximum"], 1);
  std::int64_t cells = 0;
  for (const Json& count : prisms["volume"]["histogram"]["counts"]) cells += count.get<std::int64_t>();
  EXPECT_EQ(cells, 6);
  EXPECT_LE(prisms["volume"]["percentile_50"], 1);
  EXPECT_FALSE(quality["places"].empty());
  const Json worst = quality["worst"]["edge_ratio"][0];
  EXPECT_EQ(worst["shape"], "prisms");
  EXPECT_EQ(worst["center"][2], 5);
  EXPECT_EQ(worst["value"], prisms["edge_ratio"]["maximum"]);
}

TEST_F(QualityCommand, JsonHasTheNumbersWhateverTheRanks) {
  const CommandResult ended = expect(0, "quality stack.mesh --json");
  EXPECT_EQ(ended.out, run_alone("quality stack.mesh --json").out);
  const Json report = Json::parse(ended.out);
  expect_counts(report);
  expect_qualities(report["quality"]);
}

TEST_F(QualityCommand, TextHasThemForPeopleAndTheFileForPrograms) {
  expect(0, "quality stack.mesh --output new/quality.json",
         {"the wall", "scaled Jacobian of prisms", "#####", "defects: none", "worst places, of all cells",
          "worst cells", "3 cells turned", "as cell-centred solvers judge", "skewness of faces"});
  const Json report = read_json("new/quality.json");
  expect_counts(report);
  expect_qualities(report["quality"]);
}

struct Limit {
  std::string key, loose, tight;
};

/// Each key with a limit that the mesh keeps, and one beyond what it has.
std::vector<Limit> limits() {
  std::vector<Limit> all;
  for (const char* key : {"smallest_angle", "percentile_01", "percentile_1", "percentile_5"})
    all.push_back({key, "0", "90"});
  for (const char* key : {"min_mean_ratio", "mean_mean_ratio", "min_scaled_jacobian"})
    all.push_back({key, "0", "1"});
  for (const char* key : {"largest_volume_ratio", "largest_edge_ratio"}) all.push_back({key, "1e3", "1"});
  all.push_back({"largest_angle", "180", "1"});
  all.push_back({"largest_non_orthogonality", "180", "0"});
  all.push_back({"largest_skewness", "1e3", "0"});
  all.push_back({"largest_aspect_ratio", "1e6", "1"});
  all.push_back({"min_determinant", "0", "1"});
  return all;
}

TEST_F(QualityCommand, EveryLimitIsKnownAndMissed) {
  std::string loose = "quality stack.mesh --json", tight = loose;
  for (const Limit& limit : limits()) {
    loose += " --gate." + limit.key + "=" + limit.loose;
    tight += " --gate." + limit.key + " " + limit.tight;
  }
  expect(0, loose);
  const CommandResult missed = expect(6, tight);
  EXPECT_FALSE(Json::parse(missed.out)["gate"]["passed"].get<bool>());
  for (const Limit& limit : limits())
    EXPECT_NE(missed.err.find("improve.gate." + limit.key + " is"), std::string::npos) << limit.key << missed;
  const CommandResult one = expect(6, "quality stack.mesh --gate.largest_edge_ratio=3");
  EXPECT_NE(one.err.find("(cell "), std::string::npos) << one;
  EXPECT_NE(one.err.find("5)"), std::string::npos) << one;
}

TEST_F(QualityCommand, MistakesAreRefused) {
  expect(2, "quality stack.mesh --gate.smallest_angel=3", {"smallest_angel"});
  expect(2, "quality stack.mesh --gate.largest_edge_ratio=0.5", {"largest_edge_ratio"});
  expect(2, "quality stack.mesh --gate.min_mean_ratio=much", {"min_mean_ratio"});
  write("torn.mesh", stack_of_prisms().substr(0, 300));
  write("mesh.stl", "solid");
  for (const std::string file : {"torn.mesh", "absent.meshb", "mesh.stl"}) {
    const CommandResult ended = expect(7, "quality " + file);
    EXPECT_NE(ended.err.find(file), std::string::npos) << ended;
  }
  const CommandResult ended = expect(7, "quality stack.mesh --output stack.mesh/no.json");
  EXPECT_NE(ended.err.find("no.json"), std::string::npos) << ended;
}

}  // namespace
}  // namespace aeroloom::pipeline
