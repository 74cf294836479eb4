// Runs on files that no program should write, but some do.
#include "tests/pipeline/command_line.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;

class OddFiles : public CommandLine {
protected:
  std::string fluid_case(const std::string& file) const {
    return "geometry: {file: '" + file + "', domain: fluid}\nsizing: {target_tetrahedra: 500}\n" +
           "output: {pictures: false}\n";
  }
};

/// A cube of triangles; `zero` is what stands for a coordinate of one corner.
std::string cube_stl(const std::string& name, const std::string& zero = "0") {
  const std::string o = zero + " 0 0", x = "1 0 0", y = "0 1 0", z = "0 0 1", xy = "1 1 0", yz = "0 1 1",
                    xz = "1 0 1", all = "1 1 1";
  const auto triangle = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
  };
  return "solid " + name + "\n" + triangle(o, y, x) + triangle(y, xy, x) + triangle(z, xz, yz) +
         triangle(xz, all, yz) + triangle(o, x, z) + triangle(x, xz, z) + triangle(y, yz, xy) +
         triangle(yz, all, xy) + triangle(o, z, y) + triangle(z, yz, y) + triangle(x, xy, xz) +
         triangle(xy, all, xz) + "endsolid\n";
}

TEST_F(OddFiles, ADenormalCoordinateIsZero) {
  write("case.yaml", fluid_case(write("tiny.stl", cube_stl("box", "1e-320"))));
  expect(0, "run case.yaml", {"coordinates are so small"});
  EXPECT_NEAR(read_json("out/report.json")["mesh"]["volume"].get<double>(), 1, 1e-12);
}

TEST_F(OddFiles, NamesWithoutEndAreCutAndSaid) {
  write("case.yaml", fluid_case(write("long.stl", cube_stl(std::string(2'000'000, 'n')))));
  expect(0, "run case.yaml", {"1 names are longer than 4096 bytes"});
  if (!world.is_root()) return;
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
    if (entry.is_regular_file()) bytes += entry.file_size();
  EXPECT_LT(bytes, 2'000'000U);
}

TEST_F(OddFiles, AMarkOfUtf8StandsBeforeCaseAndTriangles) {
  const std::string mark = "\xEF\xBB\xBF";
  write("case.yaml", mark + fluid_case(write("marked.stl", mark + "\n\n" + cube_stl("box"))));
  expect(0, "check case.yaml", {"a volume can be meshed"});
  expect(0, "info " + path("marked.stl"), {"STL"});
}

// A mesh that was kept is not that of other points, though the file that the case names is the same.
TEST_F(OddFiles, PointsBesideTheFileAreInTheHashOfTheInput) {
  const std::string facets =
      "0 3 0 0\n6 0\n1\n4 1 4 3 2\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n1\n4 4 1 5 "
      "8\n0\n0\n";
  const auto points = [](const std::string& a) {
    return "8 3 0 0\n1 0 0 0\n2 " + a + " 0 0\n3 " + a + " " + a + " 0\n4 0 " + a + " 0\n5 0 0 " + a +
           "\n6 " + a + " 0 " + a + "\n7 " + a + " " + a + " " + a + "\n8 0 " + a + " " + a + "\n";
  };
  write("case.yaml", fluid_case(write("cube.poly", facets)));
  write("cube.node", points("1"));
  expect(0, "run case.yaml --checkpoints");
  EXPECT_NEAR(read_json("out/report.json")["mesh"]["volume"].get<double>(), 1, 1e-12);
  write("cube.node", points("2"));
  expect(2, "run case.yaml --resume", {"Remedy"});
  expect(0, "run case.yaml");
  EXPECT_NEAR(read_json("out/report.json")["mesh"]["volume"].get<double>(), 8, 1e-12);
}

}  // namespace
}  // namespace aeroloom::pipeline
