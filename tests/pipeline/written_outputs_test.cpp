// Names of the files of a mesh, and which of those in a folder are of another run.
#include "pipeline/write_outputs.hpp"
#include "tests/pipeline/command_line.hpp"

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using Names = std::set<std::string>;

Names left(const EarlierFiles& files, const std::string& hash = {}) {
  const std::vector<std::string> names = files.left(hash);
  return {names.begin(), names.end()};
}

class EarlierFilesLocal : public CommandLine {
protected:
  cases::OutputOptions output() const {
    cases::OutputOptions options;
    options.directory = path("out");
    return options;
  }
  void write_anew(const std::string& name) const {
    const auto before = std::filesystem::last_write_time(folder / "out" / name);
    write("out/" + name, "new");
    std::filesystem::last_write_time(folder / "out" / name, before + std::chrono::seconds(1));
  }
};

TEST_F(EarlierFilesLocal, AreThoseThatNobodyHasWrittenAnew) {
  for (const char* name :
       {"out/mesh.pvtu", "out/mesh.su2", "out/surface.pvtp", "out/openfoam/mesh.foam", "out/notes.txt"})
    write(name, "old");
  const EarlierFiles files(output());
  EXPECT_EQ(left(files), (Names{"surface.pvtp", "mesh.pvtu", "mesh.su2", "mesh.foam"}));
  write_anew("mesh.pvtu");
  write_anew("surface.pvtp");
  EXPECT_EQ(left(files), (Names{"mesh.su2", "mesh.foam"}));
  std::filesystem::remove(folder / "out" / "mesh.su2");
  EXPECT_EQ(left(files), Names{"mesh.foam"});
}

TEST_F(EarlierFilesLocal, AreOfThisRunWhereTheirReportTellsOfTheSameMesh) {
  write("out/mesh.pvtu", "old");
  write("out/mesh.su2", "older");
  write("out/report.json", R"({"mesh": {"hash": "abc"}, "older_files": ["mesh.su2"]})");
  const EarlierFiles files(output());
  EXPECT_EQ(left(files, "abc"), Names{"mesh.su2"}) << "the report itself calls it older";
  EXPECT_EQ(left(files, "abd"), (Names{"mesh.pvtu", "mesh.su2"}));
  EXPECT_EQ(left(files), (Names{"mesh.pvtu", "mesh.su2"})) << "a run without a mesh";
}

TEST_F(EarlierFilesLocal, AreOfNobodyWhereTheirReportCannotBeRead) {
  write("out/mesh.pvtu", "old");
  for (const char* report :
       {"", "[1, 2", "[]", R"({"mesh": 5})", R"({"mesh": {"hash": ""}})", R"({"older_files": [5]})"}) {
    write("out/report.json", report);
    EXPECT_EQ(left(EarlierFiles(output()), "abc"), Names{"mesh.pvtu"}) << report;
  }
}

TEST_F(EarlierFilesLocal, AreNoneInAFolderThatIsNotThere) {
  EXPECT_EQ(left(EarlierFiles(output())), Names());
}

TEST(WrittenOutputsLocal, HaveTheNameOfTheirFormat) {
  cases::OutputOptions output;
  output.directory = "there";
  EXPECT_EQ(path_of(output, io::FileFormat::vtu), "there/mesh.pvtu");
  EXPECT_EQ(path_of(output, io::FileFormat::su2), "there/mesh.su2");
  EXPECT_EQ(path_of(output, io::FileFormat::openfoam), "there/openfoam/mesh.foam");
  EXPECT_TRUE(wants_vtk(output));
  output.formats = {io::FileFormat::su2};
  EXPECT_FALSE(wants_vtk(output));
}

}  // namespace
}  // namespace aeroloom::pipeline
