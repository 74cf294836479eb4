// What info, quality and improve tell of a mesh whose regions have nodes of their own on their interface.
#include "tests/pipeline/command_line.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;

/// Two unit cubes of six tetrahedra side by side, which share the nodes at x = 1, or have them twice.
std::string two_cubes(bool doubled, std::array<int, 2> regions) {
  std::string points, cells;
  const int second = doubled ? 9 : 5;  // the number of the first node of the second cube
  int count = 0;
  for (int cube = 0; cube < 2; ++cube) {
    for (int x = cube; x <= cube + 1; ++x) {
      if (cube == 1 && x == 1 && !doubled) continue;
      for (const int y : {0, 1})
        for (const int z : {0, 1}) points += fmt::format("{} {} {} 0\n", x, y, z), ++count;
    }
    std::array<int, 3> steps{4, 2, 1};
    std::sort(steps.begin(), steps.end());
    do {
      const int first = cube == 0 ? 1 : second;
      cells += fmt::format("{} {} {} {} {}\n", first, first + steps[0], first + steps[0] + steps[1],
                           first + 7, regions[static_cast<std::size_t>(cube)]);
    } while (std::next_permutation(steps.begin(), steps.end()));
  }
  return fmt::format("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n{}Tetrahedra\n12\n{}End\n", count,
                     points, cells);
}

class DoubledNodes : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("doubled.mesh", two_cubes(true, {1, 2}));
    write("joined.mesh", two_cubes(false, {1, 2}));
    write("slit.mesh", two_cubes(true, {1, 1}));
    write("doubled.names", names);
    write("joined.names", names);
  }
  Json doubled(const std::string& line) const { return Json::parse(expect(0, line).out)["doubled_nodes"]; }

private:
  static constexpr const char* names = "tetrahedra 1 left\ntetrahedra 2 right\n";
};

TEST_F(DoubledNodes, AreCountedWithRegionsAndPatches) {
  for (const std::string command : {"info --json ", "quality --json "}) {
    const Json found = doubled(command + "doubled.mesh");
    EXPECT_EQ(found, Json::parse(run_alone(command + "doubled.mesh").out)["doubled_nodes"]);
    EXPECT_EQ(found["nodes"], 4);
    EXPECT_EQ(found["faces"], 4);
    EXPECT_EQ(found["place"], Json::array({1, 0, 0}));
    EXPECT_EQ(found["regions"], Json::array({"left", "right"}));
    EXPECT_EQ(found["patches"], Json::array({"boundary_of_left", "boundary_of_right"}));
    EXPECT_EQ(doubled(command + "joined.mesh")["nodes"], 0);
  }
}

TEST_F(DoubledNodes, AreToldToPeople) {
  const std::string what =
      "4 nodes lie at the places of others, the first at (1, 0, 0), on an interface "
      "between the regions 'left' and 'right'";
  for (const std::string command : {"info ", "quality "}) {
    expect(0, command + "doubled.mesh",
           {what, "'boundary_of_left' and 'boundary_of_right'", "not connected"});
    EXPECT_FALSE(expect(0, command + "joined.mesh").has("places of others"));
    expect(0, command + "slit.mesh", {"within the region", "as at a slit"});
  }
  expect(0, "improve doubled.mesh --set output.directory=out", {what});
}

}  // namespace
}  // namespace aeroloom::pipeline
