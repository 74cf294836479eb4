// The command line as a user meets it: mistakes, files that are none, how much is said, versions.
#include "tests/pipeline/command_line.hpp"

#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

struct Mistake {
  std::string line;
  std::vector<std::string> words;
};

TEST_F(CommandLine, MistakesAreToldInOneMessage) {
  for (const Mistake& mistake :
       std::vector<Mistake>{{"", {"a command is missing", "improve", "aeroloom --help"}},
                            {"rnu case.yaml", {"unknown command 'rnu'", "did you mean 'run'?"}},
                            {"run case.yaml --sett a=b", {"unknown option '--sett'", "'--set'"}},
                            {"quality m.vtu --gate.smalest_angle=3", {"'--gate.smallest_angle'"}},
                            {"convert a.vtu", {"to is required", "aeroloom convert --help"}},
                            {"convert a.vtu b --format cgn", {"no format is called 'cgn'", "'cgns'"}},
                            {"run case.yaml again.yaml", {"unexpected argument 'again.yaml'"}},
                            {"--bogus", {"unknown option '--bogus'"}},
                            {"run case.yaml --resume --checkpoints", {"excludes"}},
                            {"-v run case.yaml -q", {"--verbose and --quiet exclude each other"}},
                            {"info case.yaml -q -v", {"--verbose and --quiet exclude each other"}},
                            {"run case.yaml --set sizng.minimum=1", {"did you mean 'sizing'?"}}}) {
    write("case.yaml", coarse_transport());
    const CommandResult ended = expect(2, mistake.line, mistake.words);
    EXPECT_EQ(ended.out, "") << mistake.line;
    EXPECT_EQ(count_of("error", ended.err), 1) << ended;
  }
}

TEST_F(CommandLine, AmountsOfMemoryAreUnderstoodOrRefused) {
  write("case.yaml", coarse_duct());
  for (const char* size : {"8X", "0G", "101%", "G", "-1G", "12", "1e30G"})
    expect(2, std::string("run case.yaml --max-memory=") + size, {"is no amount of memory"});
}

struct Refused {
  std::string line;
  int code;
  std::vector<std::string> words;
};

TEST_F(CommandLine, FilesThatCannotBeUsedAreToldInOneLine) {
  std::string step = "ISO-10303-21;\n", words;
  for (int i = 0; i < 1000; ++i) {
    step += "#1=CARTESIAN_POINT('',(0.,0.,0.));\n";
    words += "word ";
  }
  write("cad.stp", step);
  write("long.yaml", words);
  write("absent.yaml", "geometry: {file: absent.stp}\n");
  write("case.yaml", coarse_transport());
  for (const Refused& refused : std::vector<Refused>{
           {"run cad.stp", 2, {"a geometry, but a case", "aeroloom init case.yaml --geometry cad.stp"}},
           {"run nowhere.yaml", 2, {"cannot be opened: No such file or directory", "aeroloom init"}},
           {"run .", 2, {"cannot be opened: Is a directory"}},
           {"run long.yaml", 2, {"expected keys, got 'word", "...'"}},
           {"info absent.vtu", 7, {"cannot read 'absent.vtu': No such file or directory"}},
           {"check absent.yaml", 7, {"cannot read 'absent.stp': No such file or directory"}},
           {"schema --output /proc/x", 7, {"cannot write '/proc/x': No such file or directory"}},
           {"run case.yaml --set output.directory=/proc/x", 7, {"output.directory:", "'/proc/x'"}}}) {
    const CommandResult ended = expect(refused.code, refused.line, refused.words);
    EXPECT_EQ(ended.out, "") << refused.line;
    EXPECT_LT(ended.err.size(), 300u) << ended;
    EXPECT_FALSE(ended.has("iostream") || ended.has("filesystem error")) << ended;
  }
}

TEST_F(CommandLine, NulHasNoPlaceInAName) {
  write("nul.yaml", "geometry: {file: \"wing.step\\0.igs\"}\n");
  expect(2, "run nul.yaml", {"without NUL"});
}

TEST_F(CommandLine, ThousandsOfDotsAndOfPatchesTakeNoTime) {
  write("case.yaml", coarse_duct());
  std::string dots;
  for (int i = 0; i < 10000; ++i) dots += "a.";
  const CommandResult refused = expect(2, "run case.yaml --set " + dots + "b=1");
  EXPECT_LT(refused.seconds, 10);
  EXPECT_LT(refused.err.size(), 300u);
  std::string many = "geometry: {builtin: transport}\npatches:\n";
  for (int i = 0; i < 30000; ++i) many += "  p" + std::to_string(i) + ": {faces: [fuselage]}\n";
  write("many.yaml", many);
  EXPECT_LT(expect(0, "info many.yaml").seconds, 30);
}

// -q leaves warnings and errors, wherever it stands; -v says more.
TEST_F(CommandLine, SaysAsMuchAsIsWanted) {
  write("case.yaml", coarse_duct());
  EXPECT_EQ(expect(0, "run case.yaml -q").out, "");
  const CommandResult normal = expect(0, "run case.yaml"), verbose = expect(0, "-v run case.yaml");
  EXPECT_GT(normal.out.size(), 0u);
  EXPECT_GT(verbose.out.size(), normal.out.size());
  EXPECT_EQ(expect(0, "-q convert " + mesh() + " a.cgns").text(), "");
  EXPECT_EQ(expect(0, "convert " + mesh() + " a.cgns --quiet").text(), "");
  EXPECT_NE(expect(0, "convert " + mesh() + " a.cgns").out.find("wrote"), std::string::npos);
}

TEST_F(CommandLine, VersionsOfAllLibrariesAreTold) {
  const CommandResult ended = expect(0, "--version", {"AGPL"});
  EXPECT_TRUE(ended.out.starts_with("aeroloom ")) << ended;
  for (const char* library : {"OpenCASCADE", "TetGen", "VTK", "HDF5", "METIS", "p4est", "muparser", "CGAL",
                              "Eigen", "MPI", "yaml-cpp", "nlohmann_json", "CLI11", "fmt", "spdlog"}) {
    const std::regex line(std::string("\n  ") + library + " +\\S*.*\\d+\\.\\d+");
    EXPECT_TRUE(std::regex_search(ended.out, line)) << library << ": " << ended;
  }
}

/// Names of all commands, as the help of the program lists them.
std::set<std::string> commands_of(const std::string& help) {
  const std::size_t begin = help.find("\nCommands:"), end = help.find("Examples:", begin);
  const std::string list = help.substr(begin, end - begin);
  const std::regex line("\n  ([a-z-]+) {2,}\\S");
  std::set<std::string> names;
  for (std::sregex_iterator found(list.begin(), list.end(), line), none; found != none; ++found)
    names.insert((*found)[1]);
  return names;
}

TEST_F(CommandLine, EveryCommandHasHelpWithExamplesAndExitCodes) {
  const std::set<std::string> commands = commands_of(expect(0, "--help", {"Exit codes:"}).out);
  for (const char* name : {"run", "check", "info", "improve", "quality", "convert", "export-cad",
                           "completion", "init", "schema", "scaling"})
    EXPECT_TRUE(commands.contains(name)) << name;
  for (const std::string& command : commands) {
    const CommandResult ended = expect(0, command + " --help", {"Examples:", "Exit codes:"});
    EXPECT_TRUE(std::regex_search(ended.out, std::regex("\n  (mpirun -n \\d+ )?aeroloom .*\n"))) << ended;
    EXPECT_EQ(ended.err, "");
    EXPECT_EQ(count_of("Exit codes:", ended.out), 1) << "one rank speaks";
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
