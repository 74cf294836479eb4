// What runs leave in a folder where others were before: nothing is lost, and nothing passes for another's.
#include "tests/pipeline/command_line.hpp"
#include "tests/scoped_fault.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class WrittenFiles : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("case.yaml", coarse_duct());
  }
  std::vector<std::string> older_files() const {
    return read_json("out/report.json")["older_files"].get<std::vector<std::string>>();
  }
};

/// What one rank says of a folder, or of lengths.
class WrittenFilesLocal : public WrittenFiles {};

TEST_F(WrittenFilesLocal, OlderOnesAreTold) {
  expect(0, "run case.yaml --set output.formats=[vtu,su2]");
  // Of the same mesh, which was made again without it.
  EXPECT_FALSE(expect(0, "run case.yaml").has("not of this run"));
  const CommandResult other = expect(0, "run case.yaml --set sizing.target_tetrahedra=2500");
  EXPECT_NE(other.err.find("not of this run: mesh.su2"), std::string::npos) << other;
  EXPECT_EQ(older_files(), std::vector<std::string>{"mesh.su2"});
  const std::string before = read("out/mesh.pvtu");
  {
    const ScopedFault fault("zone=aborts");
    expect(5, "run case.yaml");
  }
  EXPECT_EQ(read("out/mesh.pvtu"), before);
  const std::vector<std::string> older = older_files();
  EXPECT_EQ(std::count(older.begin(), older.end(), "mesh.pvtu"), 1);
  at_root([&] { fs::remove(path("out/mesh.su2")); });
  EXPECT_FALSE(expect(0, "run case.yaml").has("mesh.su2"));
}

// What an unfinished file's name points to is nobody's business.
TEST_F(WrittenFiles, LinksAreNotFollowed) {
  const std::string precious = write("precious", "precious");
  for (const std::string name : {"report.json", "report.html", "mesh.pvtu", "mesh.su2", "mesh.cgns",
                                 "mesh.meshb", "mesh.msh", "mesh.vtkhdf"}) {
    at_root([&] {
      fs::create_directories(folder / "out");
      fs::create_symlink(precious, path("out/" + name + ".unfinished"));
    });
  }
  expect(0, "run case.yaml --set output.formats=[vtu,su2,cgns,meshb,msh,vtkhdf]");
  EXPECT_EQ(read("precious"), "precious");
}

// Reports replace links as mesh files do, and so do folders of parts; what links lead to stays as it is.
TEST_F(WrittenFiles, LinksAreReplaced) {
  const std::string precious = write("precious", "precious");
  write("elsewhere/old", "old");
  at_root([&] {
    fs::create_directories(folder / "out");
    for (const char* name : {"report.json", "report.html", "tasks.csv", "mesh.pvtu", "surface.pvtp"})
      fs::create_symlink(precious, path(std::string("out/") + name));
    fs::create_directory_symlink(path("elsewhere"), path("out/mesh"));
  });
  expect(0, "run case.yaml --set output.tasks=true");
  EXPECT_EQ(read("precious"), "precious");
  for (const char* name : {"report.json", "report.html", "tasks.csv", "mesh.pvtu", "surface.pvtp", "mesh"})
    EXPECT_FALSE(fs::is_symlink(folder / "out" / name)) << name;
  EXPECT_TRUE(fs::is_directory(folder / "out/mesh"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "elsewhere"), {}), 1);
  at_root([&] { fs::create_symlink(precious, path("out/check.json")); });
  expect(0, "check case.yaml");
  EXPECT_EQ(read("precious"), "precious");
}

TEST_F(WrittenFiles, WhatIsInTheWayIsFoundBeforeTheWork) {
  for (const std::string name : {"mesh", "surface", "openfoam"}) {
    write("out/" + name, "a file");
    const CommandResult ended = expect(7, "run case.yaml --set output.formats=[vtu,openfoam]",
                                       {"a file is in the way of a folder. Remedy", "out/" + name});
    EXPECT_FALSE(ended.has("stage surface")) << ended;
    EXPECT_FALSE(exists("out/mesh.pvtu"));
    at_root([&] { fs::remove(folder / "out" / name); });
  }
  for (const std::string name : {"report.json", "mesh.su2", "mesh_markers.cfg"}) {
    at_root([&] { fs::create_directories(folder / "out" / name); });
    const CommandResult ended = expect(7, "run case.yaml --set output.formats=[su2]",
                                       {"a folder is in the way of a file. Remedy", "out/" + name});
    at_root([&] { fs::remove(folder / "out" / name); });
  }
}

TEST_F(WrittenFilesLocal, BoundsThatWinOverCurvatureAreTold) {
  write("case.yaml", coarse_wing());
  const CommandResult ended =
      expect(0, "run case.yaml --set sizing.curvature_angle=2", {"wins over 2 degrees per element: on "});
  EXPECT_NE(ended.err.find("% of the body. Remedy"), std::string::npos) << ended;
  EXPECT_NE(ended.out.find("\n  sizing: elements turn by"), std::string::npos) << ended;
  const Json report = read_json("out/report.json"), bounded = report["sizing"]["bounded_by_minimum"];
  ASSERT_FALSE(bounded.empty());
  double share = 0;
  for (const Json& face : bounded) {
    EXPECT_GT(face["fraction"].get<double>(), 0);
    EXPECT_LE(face["fraction"].get<double>(), 1);
    EXPECT_GT(face["degrees"].get<double>(), 2);
    share += face["share_of_body"].get<double>();
  }
  EXPECT_GT(share, 0.1);
}

// A case in metres and seconds made of lengths that are not, over results of another mesh.
TEST_F(WrittenFilesLocal, OpenFoamIsWarnedOfUnitsAndOfOtherResults) {
  const std::string line =
      "run /dev/null --set geometry.file=" + (source_tree() / "tests/data/bracket.igs").string() +
      " --set output.directory=foam --set output.formats=[openfoam] --set output.parts=1 "
      "--set geometry.domain=fluid --set output.pictures=false --set sizing.target_tetrahedra=";
  const CommandResult first =
      expect(0, line + "4000", {"lengths stay in mm", "transformPoints -scale '(0.001 0.001 0.001)'"});
  EXPECT_FALSE(first.has("fields of another mesh")) << first;
  const nlohmann::json warnings = read_json("foam/report.json")["warnings"];
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0]["message"].get<std::string>().find("stay in mm"), std::string::npos) << warnings;
  write("foam/openfoam/50/U", "results\n");
  expect(0, line + "6000", {"50' holds fields of another mesh"});
  EXPECT_TRUE(exists("foam/openfoam/50/U"));
}

}  // namespace
}  // namespace aeroloom::pipeline
